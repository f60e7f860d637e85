//! The page of the book on the case file: every key, as Markdown.

use std::fmt::Write;
use std::path::PathBuf;

use condyle::machine::knee::KNEE;
use condyle::machine::{Channel, JointKind};
use condyle::parameter::{Known, Parameter, unit_of};
use condyle::wear::{WEAR_LAWS, WearLawKind};

use super::cases;
use crate::case::machine::{Freedom, FreedomKeys, joints_in_files};
use crate::case::waveform::{WaveformSource, knots_key, words_of};
use crate::case::{Case, WearLaws};
use crate::config::*;

const OPENING: &str = "\
# The case file

A case is a TOML file. This page lists all its keys. Keys with a default may be omitted, the names of numbers end with
their units, and paths are relative to the folder of the case file.

Editors complete keys, show their meaning, unit and range, and underline errors with the schema that
`condyle schema > condyle.schema.json` writes. taplo and the extension Even Better TOML of VS Code find it by the first
line of the case, `#:schema condyle.schema.json`, which the shipped cases have and `condyle new` writes. `condyle check`
also checks that files exist and that values fit each other.

## Top of the file

";

const ACTIVITIES: &str = "
One table for each activity, with every waveform that its freedoms need, as `[activity.axial_force]`, `[activity.flexion]` and so on, with the keys of the waveforms above; `[machine]` then has none ([Activities and creep](activities-and-creep.md)). On a machine by joints, an activity has a [machine file](machines.md#activities) instead.
";

/// Returns the page, for a case that may choose from `wear_laws`.
pub(super) fn schema_markdown(wear_laws: WearLaws) -> String {
    let items = Case::items_with(wear_laws);
    let sections = sections("", &items, wear_laws);
    format!("{OPENING}{}{sections}", rows(&keys(&items)))
}

/// Returns the sections on the tables among `items`, `above` being the path of the table around them.
fn sections(above: &str, items: &[Item], wear_laws: WearLaws) -> String {
    let inside = items.iter().flat_map(|item| match item {
        Item::Choice(choices) => choices
            .offered
            .iter()
            .flat_map(|offer| &offer.items)
            .collect(),
        item => vec![item],
    });
    let sections = inside.filter_map(|item| match item {
        Item::Table(table) if above.is_empty() => Some(section(table.name, table, wear_laws)),
        Item::Table(table) => {
            let path = format!("{above}.{}", table.name);
            Some(shared_section(&path).unwrap_or_else(|| section(&path, table, wear_laws)))
        }
        _ => None,
    });
    sections.collect()
}

fn section(path: &str, table: &TableItem, wear_laws: WearLaws) -> String {
    let title = if table.is_list {
        format!("[[{path}]]")
    } else {
        format!("[{path}]")
    };
    let mut text = format!("\n## `{title}`\n\n{}", rows(&keys(&table.items)));
    for item in &table.items {
        let Item::Choice(choices) = item else {
            continue;
        };
        for offer in &choices.offered {
            let keys = keys(&offer.items);
            if !keys.is_empty() {
                let (by, word) = (choices.by.name, offer.word);
                text += &format!("\nWith `{by} = \"{word}\"`:\n\n{}", rows(&keys));
            }
        }
    }
    text + &note(path, wear_laws) + &sections(path, &table.items, wear_laws)
}

/// Returns the text after the keys of a table.
fn note(path: &str, wear_laws: WearLaws) -> String {
    match path {
        "activity" => ACTIVITIES.to_owned(),
        "wear" => {
            let lines: String = wear_laws.iter().map(|law| law_line(law)).collect();
            format!("\n{lines}")
        }
        _ => String::new(),
    }
}

/// Returns the section on a table that is described together with others, at the first of them; empty at the others.
fn shared_section(path: &str) -> Option<String> {
    let waveform = |name| {
        KNEE.channels
            .iter()
            .position(|channel| channel.name == name)
    };
    match path.split_once('.')? {
        ("machine", "freedoms") => Some(freedoms()),
        ("machine", name) => match waveform(name)? {
            0 => Some(waveforms()),
            _ => Some(String::new()),
        },
        // Their joints and waveforms are those of the machine.
        ("activity", _) => Some(String::new()),
        _ => None,
    }
}

fn freedoms() -> String {
    let of_kind = [JointKind::Translation, JointKind::Rotation].map(|kind| {
        let joints = joints_in_files().filter(|joint| joint.kind() == kind);
        let names: Vec<&str> = joints.map(|joint| joint.name).collect();
        let (last, others) = names
            .split_last()
            .expect("a machine has freedoms of each kind");
        let others = others.join(", .");
        let (drive, numbers) = (Freedom::drive_key(), FreedomKeys::items(kind));
        let rows = rows(&[vec![&drive], keys(&numbers)].concat());
        format!("\n## `[machine.freedoms.{others} and .{last}]`\n\n{rows}")
    });
    of_kind.concat()
}

fn waveforms() -> String {
    let table = |channel: &&Channel| format!("`[machine.{}]`", channel.name);
    let tables: Vec<String> = KNEE.channels.iter().map(table).collect();
    let keys = rows(&keys(&WaveformSource::items()));
    let row = |channel: &&'static Channel| {
        let key = knots_key(channel);
        let range = key.limits.map(|limits| limits.to_string());
        let key = key.name;
        format!(
            "| `{}` | `{key}` | {} | {} | {} | {} |\n",
            channel.name,
            unit_of(key).unwrap_or_default(),
            range.unwrap_or_default(),
            words_of(channel).join(", "),
            channel.about,
        )
    };
    let channels: String = KNEE.channels.iter().map(row).collect();
    format!(
        "\n## Waveforms: {}\n\n\
        One of `waveform`, `file` or the points themselves; `iso-like` if none of them is given, except in an activity. A freedom takes the waveform that its drive \
        needs; one for another drive is an error.\n\n{keys}\n\
        | table | points | unit | values may be | shipped waveforms | meaning |\n\
        | --- | --- | --- | --- | --- | --- |\n{channels}",
        tables.join(", ")
    )
}

fn rows(keys: &[&Key]) -> String {
    let mut text =
        "| key | unit | may be | default | meaning |\n| --- | --- | --- | --- | --- |\n".to_owned();
    for key in keys {
        let (name, kind, doc) = (key.name, &key.kind, &key.doc);
        let unit = unit_of(name).unwrap_or("");
        let range = key
            .limits
            .map(|limits| format!(", {limits}"))
            .unwrap_or_default();
        let default = match &key.silent {
            WhereSilent::Takes(text) => format!("`{text}`"),
            WhereSilent::LeftOut => "none".to_owned(),
            WhereSilent::MustBeGiven => "must be given".to_owned(),
        };
        let row = writeln!(
            text,
            "| `{name}` | {unit} | {kind}{range} | {default} | {doc} |"
        );
        debug_assert!(row.is_ok(), "writing to a String does not fail");
    }
    text
}

/// Returns the formula of a law and the sources of its constants.
fn law_line(law: &WearLawKind) -> String {
    let source = |parameter: &Parameter| match parameter.source {
        "choice" => "choice".to_owned(),
        key if parameter.known == Known::Approximate => format!("[{key}] (approximate)"),
        key => format!("[{key}]"),
    };
    let sources: Vec<String> = law.parameters.iter().map(source).collect();
    let (word, about, sources) = (law.word, law.about, sources.join(", "));
    let formula = if law.known == Known::Approximate {
        " The formula is approximate: quoted from memory, not checked at the source."
    } else {
        ""
    };
    let constants = if sources.is_empty() {
        String::new()
    } else {
        format!(" Sources of the constants, in the order of the table: {sources}.")
    };
    format!("- `{word}`: {about}{constants}{formula}\n")
}

fn path_in_book() -> PathBuf {
    cases().join("../docs/src/case-file.md")
}

#[test]
fn page_of_keys_has_unit_range_default_and_meaning() {
    let page = schema_markdown(WEAR_LAWS);
    let row = "| `edge_mm` | mm | a number, 0.1 to 10 | `1.05` | Edge of a hexahedron, seen from above. |";
    assert!(page.contains(row), "{page}");
    assert!(page.contains("| `file` |  | a path in quotes | must be given |"));
    assert!(page.contains("| `axial_force` | `knots_n` | N | 0 to 20000 | iso-like, paper-like, stairs-like, chair-like |"));
}

#[test]
fn page_of_keys_in_the_book_is_up_to_date() {
    let page = std::fs::read_to_string(path_in_book()).unwrap_or_default();
    let advice = "run: cargo test -p condyle-case write_page_of_keys -- --ignored";
    assert!(page == schema_markdown(WEAR_LAWS), "{advice}");
}

#[test]
#[ignore = "writes the page of the book"]
fn write_page_of_keys() {
    let written = std::fs::write(path_in_book(), schema_markdown(WEAR_LAWS));
    written.expect("the folder of the book is there");
}
