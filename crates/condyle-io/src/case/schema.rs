//! The page of the book that lists every key.

use condyle::machine::{JointKind, knee::KNEE};
use condyle::parameter::{Known, Parameter};
use condyle::wear::WearLawKind;

use super::activity::ActivityKeys;
use super::contact::{Contact, PressureLawChoice};
use super::deformable::BacksideChoice;
use super::deformable::PlasticityChoice;
use super::femur::Femur;
use super::femur::FemurPlacement;
use super::frame::Heading;
use super::insert::Insert;
use super::insert::InsertPlacement;
use super::machine::{MachineSettings, Rotation, Springs, Start, Translation};
use super::material::Creep;
use super::material::CrossLinking;
use super::material::Material;
use super::run_options::Accuracy;
use super::run_options::Limits;
use super::run_options::Output;
use super::schedule::Time;
use super::schedule::{March, Update};
use super::waveform::CaseChannel;
use super::waveform::{WaveformSource, knots_key};
use super::wear::{Wear, WearLaws};
use crate::config::{Key, Page, Settings, Variants, unit_of};

const OPENING: &str = "\
# The case file

A case is a TOML file. Every key that has a default may be left out; every number has its unit in
its name; paths count from the folder of the case file. This page is made from the declarations
that the program reads a case with.

Editors complete the keys, show what each means, its unit and range, and underline what is wrong, by the schema that
`condyle schema > condyle.schema.json` writes. A case names it in its first line, `#:schema condyle.schema.json`, as the
shipped cases do and `condyle new` writes it, with the schema beside; taplo and the extension Even Better TOML of VS Code read that line. `condyle check` knows more than the
schema: files that must be there, and values that do not fit each other.

## Top of the file

";

const WAVEFORMS: &str = "\
One of `waveform`, `file` or the points themselves. A freedom takes the one its drive \
needs; one for another drive is an error.

";

const POINTS: &str = "
| table | points | unit | values may be | named | what |
| --- | --- | --- | --- | --- | --- |
";

const ACTIVITIES: &str = "
One table for each thing that the machine does, each with every waveform that its freedoms need as \
`[activity.axial_force]`, `[activity.flexion]` and so on, with the keys of the waveforms above; `[machine]` then has \
none. [Activities and creep](activities-and-creep.md) shows how.
";

/// Every key of a case file that may choose from `wear_laws`, with its unit, range, default and
/// meaning, as Markdown.
pub fn schema_markdown(wear_laws: WearLaws) -> String {
    let mut page = Page::new(OPENING);
    page.table(&Heading::keys());
    let (femur, insert) = (Femur::choices(), Insert::choices());
    let with = |by: &Key, placement: Vec<Key>| [vec![by.clone()], placement].concat();
    let of_femur = with(&femur.by, FemurPlacement::keys());
    page.chosen("`[femur]`", &of_femur, &femur);
    let of_insert = with(&insert.by, InsertPlacement::keys());
    page.chosen("`[insert]`", &of_insert, &insert);
    page.chosen("`[material]`", &Material::keys(), &CrossLinking::choices());
    page.chosen(
        "`[contact]`",
        &Contact::keys_of_page(),
        &PressureLawChoice::choices(),
    );
    let plasticity = PlasticityChoice::choices();
    page.chosen(
        "`[contact]` of a deformable insert",
        &Contact::keys_of_deformable(),
        &plasticity,
    );
    let backside = BacksideChoice::choices();
    let by = std::slice::from_ref(&backside.by);
    page.chosen("`[contact]` of a backside", by, &backside);
    machine(&mut page);
    page.section("`[[activity]]`", &ActivityKeys::keys());
    page.push(ACTIVITIES);
    wear(&mut page, wear_laws);
    let creep = Creep::choices();
    page.chosen("`[creep]`", std::slice::from_ref(&creep.by), &creep);
    page.chosen("`[march]`", &March::keys(), &Update::choices());
    page.section("`[time]`", &Time::keys());
    page.section("`[accuracy]`", &Accuracy::keys());
    page.section("`[limits]`", &Limits::keys());
    page.section("`[output]`", &Output::keys());
    page.into_text()
}

fn wear(page: &mut Page, laws: WearLaws) {
    let choices = Wear::choices(laws);
    page.chosen("`[wear]`", std::slice::from_ref(&choices.by), &choices);
    page.push("\n");
    for law in laws {
        page.push(&law_line(law));
    }
}

/// The formula of a law and where its constants are from.
fn law_line(law: &WearLawKind) -> String {
    let source = |parameter: &Parameter| match parameter.source {
        "choice" => "choice".to_owned(),
        key if parameter.known == Known::Approximate => format!("[{key}] (approximate)"),
        key => format!("[{key}]"),
    };
    let sources: Vec<String> = law.parameters.iter().map(source).collect();
    let (word, about, sources) = (law.word, law.about, sources.join(", "));
    let formula = if law.known == Known::Approximate {
        " The formula is approximate: remembered rather than read."
    } else {
        ""
    };
    let constants = if sources.is_empty() {
        String::new()
    } else {
        format!(" Its constants are from: {sources}.")
    };
    format!("- `{word}`: {about}{constants}{formula}\n")
}

fn machine(page: &mut Page) {
    let keys = [Start::keys(), MachineSettings::keys()].concat();
    page.section("`[machine]`", &keys);
    page.section("`[machine.springs]`", &Springs::keys());
    page.section(&freedoms(JointKind::Translation), &Translation::keys());
    page.section(&freedoms(JointKind::Rotation), &Rotation::keys());
    let named = |channel: CaseChannel| format!("`[machine.{}]`", channel.name());
    let tables: Vec<String> = CaseChannel::all().map(named).collect();
    page.push(&format!("\n## Waveforms: {}\n\n", tables.join(", ")));
    page.push(WAVEFORMS);
    page.table(&WaveformSource::keys());
    page.push(POINTS);
    for channel in CaseChannel::all() {
        page.push(&waveform_row(channel));
    }
}

/// The tables of all freedoms of a kind, such as `[machine.freedoms.ap], .ml and .is`.
fn freedoms(kind: JointKind) -> String {
    let joints = KNEE.in_files.into_iter().map(|index| KNEE.joint(index));
    let names: Vec<&str> = joints
        .filter(|joint| joint.kind() == kind)
        .map(|joint| joint.name)
        .collect();
    let others = names[1..].iter().map(|name| format!(".{name}"));
    let others: Vec<String> = others.collect();
    let first = format!("[machine.freedoms.{}]", names[0]);
    match others.split_last() {
        Some((last, between)) => {
            let listed = [&[first], between].concat().join(", ");
            format!("`{listed} and {last}`")
        }
        None => format!("`{first}`"),
    }
}

fn waveform_row(channel: CaseChannel) -> String {
    let key = knots_key(channel);
    format!(
        "| `{}` | `{}` | {} | {} | {} | {} |\n",
        channel.name(),
        key.name,
        unit_of(key.name).unwrap_or_default(),
        channel.limits(),
        channel.words().join(", "),
        channel.about(),
    )
}
