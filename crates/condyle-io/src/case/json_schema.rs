//! The case as a JSON schema, for editors.

use condyle::machine::{JointDescription, knee::KNEE};
use condyle::wear::WEAR_LAWS;

use super::activity::{self, ActivityKeys};
use super::contact::{Contact, PressureLawChoice};
use super::contents::Case;
use super::deformable::BacksideChoice;
use super::deformable::PlasticityChoice;
use super::femur::Femur;
use super::femur::FemurPlacement;
use super::frame::Heading;
use super::insert::Insert;
use super::insert::InsertPlacement;
use super::machine::Freedom;
use super::machine::{MachineSettings, Springs, Start};
use super::material::Creep;
use super::material::CrossLinking;
use super::material::Material;
use super::pressure_table;
use super::run_options::Accuracy;
use super::run_options::Limits;
use super::run_options::Output;
use super::schedule::Time;
use super::schedule::{March, Update};
use super::waveform::CaseChannel;
use super::waveform::{waveform_keys, ways};
use super::wear::{Wear, WearLaws};
use crate::config::{Settings, TableSchema, Variants};

/// A JSON schema, draft 2020-12, of a case file that may choose from `wear_laws`: every key with
/// its unit, range, default and meaning, from the declarations that a case is read with.
///
/// It refuses nothing that [`CaseReader`](super::CaseReader) takes. The reader knows more: files
/// that must be there, and values that do not fit each other.
pub fn json_schema(wear_laws: WearLaws) -> String {
    let case = TableSchema::new("A virtual wear test of a joint replacement: a case of condyle.")
        .with_keys(&Heading::keys())
        .with_table(
            "femur",
            TableSchema::new("The femoral component.")
                .with_choices(&Femur::choices())
                .with_keys(&FemurPlacement::keys()),
        )
        .with_table(
            "insert",
            TableSchema::new("The tibial insert.")
                .with_choices(&Insert::choices())
                .with_keys(&InsertPlacement::keys()),
        )
        .with_table("material", material())
        .with_table("contact", contact())
        .with_table("machine", machine())
        .with_list(activity::TABLE, activity_of_list())
        .with_table(
            "wear",
            TableSchema::new("The wear law.").with_choices(&Wear::choices(wear_laws)),
        )
        .with_table(
            "creep",
            TableSchema::new("How the polyethylene of the insert creeps.")
                .with_choices(&Creep::choices()),
        )
        .with_table("march", march())
        .with_table("time", of::<Time>("Steps and tolerances in time."))
        .with_table(
            "accuracy",
            of::<Accuracy>("What a run tells of its own accuracy."),
        )
        .with_table(
            "limits",
            of::<Limits>("What a run may take of the computer."),
        )
        .with_table(
            "output",
            of::<Output>("What a run writes besides what it always does."),
        );
    let mut schema = case.into_schema();
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "Case of condyle".into();
    format!("{schema:#}\n")
}

impl Case {
    /// The [`json_schema`] of a case that may choose from the wear laws that come with condyle.
    pub fn json_schema() -> String {
        json_schema(WEAR_LAWS)
    }
}

fn of<S: Settings>(about: &str) -> TableSchema {
    TableSchema::new(about).with_keys(&S::keys())
}

fn contact() -> TableSchema {
    let laws = PressureLawChoice::choices();
    TableSchema::new("Model of contact, pressure law and friction.")
        .with_keys(&Contact::keys())
        .with_choices(&Contact::models(&[], &[]))
        .with_choices(&laws)
        .with_choices(&PlasticityChoice::choices())
        .with_choices(&BacksideChoice::choices())
        .with_one_of_under(&laws, "tabulated", &pressure_table::WAYS)
        .with_one_of_under(&laws, "tabulated-strain", &pressure_table::WAYS_OF_STRAIN)
}

fn material() -> TableSchema {
    TableSchema::new("Polyethylene of the insert.")
        .with_keys(&Material::keys())
        .with_choices(&CrossLinking::choices())
}

fn march() -> TableSchema {
    TableSchema::new("The march over the life of the insert.")
        .with_keys(&March::keys())
        .with_choices(&Update::choices())
}

fn machine() -> TableSchema {
    let keys = [Start::keys(), MachineSettings::keys()].concat();
    let machine = TableSchema::new("The simulator.")
        .with_keys(&keys)
        .with_table(
            "springs",
            of::<Springs>("The pair of springs that stands for the ligaments."),
        )
        .with_table("freedoms", freedoms());
    with_waveforms(machine)
}

fn activity_of_list() -> TableSchema {
    with_waveforms(of::<ActivityKeys>(
        "Something that the machine does over and over, with inputs of its own.",
    ))
}

fn with_waveforms(table: TableSchema) -> TableSchema {
    CaseChannel::all().fold(table, |table, channel| {
        table.with_table(channel.name(), waveform(channel))
    })
}

fn freedoms() -> TableSchema {
    let joints = KNEE.in_files.into_iter().map(|index| KNEE.joint(index));
    joints.fold(TableSchema::new("The six freedoms."), |freedoms, joint| {
        freedoms.with_table(joint.name, freedom(joint))
    })
}

fn freedom(joint: &JointDescription) -> TableSchema {
    let about = format!("{}: + is {}.", joint.title, joint.positive);
    TableSchema::new(&about).with_keys(&Freedom::keys(joint))
}

fn waveform(channel: CaseChannel) -> TableSchema {
    TableSchema::new(channel.about())
        .with_keys(&waveform_keys(channel))
        .with_one_of(&ways(channel))
        .with_need("column", "file")
}
