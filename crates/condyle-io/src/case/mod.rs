//! The case file: TOML in, a checked and typed [`Case`] out, and back.
//!
//! Values stay in the units of their names; they become mm, N, s, MPa, tonne and rad only in the
//! last step, where a case is built.

pub(crate) mod axes;
mod build;
mod channel;
mod contact;
mod declared;
pub(crate) mod files;
mod fingerprint;
pub(crate) mod keys;
mod machine;
mod march;
mod origin;
mod overriding;
pub(crate) mod parse;
pub(crate) mod problems;
mod samples;
mod schema;
pub(crate) mod setting;
mod shapes;
pub(crate) mod table;
#[cfg(test)]
mod tests;
pub(crate) mod to_toml;
pub(crate) mod unknown;
mod waveforms;

use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;
use toml::de::DeTable;

pub use axes::{Axes, AxesError};
pub use build::{BuildError, BuildWarning, Built};
pub use channel::Channel;
pub use contact::{Contact, PressureLawChoice};
pub use declared::{
    Accuracy, AutoUpdates, CylinderFemur, DriveWord, FixedUpdates, FlatInsert, Friction,
    GenericFemur, GenericInsert, Heading, HexahedralInsert, IntegratorWord, LengthUnit,
    MachineSettings, Material, MeshFemur, MeshInsert, Preset, PressureForm, Rotation, Side, Sign,
    SphereFemur, Springs, StiffnessOf, Time, Translation, Wear, WearLawWord,
};
pub use files::DataFile;
pub use keys::{Key, Limits, Settings, unit_of};
pub use machine::{Freedom, Freedoms, Machine, Waveforms};
pub use march::{March, Update};
pub use overriding::{NumberKey, Override, OverrideError};
pub use problems::{CaseError, Look, Problem, Reason};
pub use schema::schema_markdown;
pub use shapes::{Femur, Insert};
pub use to_toml::template;

use origin::Origin;
use parse::{Log, Others, Section, names};
use problems::Source;

/// A wear test as its file describes it, checked, with every default filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Title and side.
    pub heading: Heading,
    /// The femoral component.
    pub femur: Femur,
    /// The tibial insert.
    pub insert: Insert,
    /// Polyethylene of the insert.
    pub material: Material,
    /// Pressure law and friction.
    pub contact: Contact,
    /// The simulator.
    pub machine: Machine,
    /// The wear law.
    pub wear: Wear,
    /// The march over the life of the insert.
    pub march: March,
    /// Steps and tolerances in time.
    pub time: Time,
    /// What a run tells of its own accuracy.
    pub accuracy: Accuracy,
    origin: Origin,
}

/// Every table of a case, in the order they are written.
const TABLES: &[&str] = &[
    "femur", "insert", "material", "contact", "machine", "wear", "march", "time", "accuracy",
];

impl Case {
    /// Reads the case file at `path`; paths in it count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with it, or that it cannot be read.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let source = table::read_source(path).map_err(CaseError::unreadable)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_source(&source, folder)
    }

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, CaseError> {
        let source = Arc::new(NamedSource::new(name, text.to_owned()));
        Self::from_source(&source, folder)
    }

    fn from_source(source: &Source, folder: &Path) -> Result<Self, CaseError> {
        let (document, errors) = DeTable::parse_recoverable(source.inner());
        let mut log = Log::new(source, folder);
        for error in &errors {
            let message = error.message().to_owned();
            log.problem(error.span().unwrap_or(0..0), Reason::Syntax { message });
        }
        let case = match errors.is_empty() {
            true => read_case(&Section::root(document.get_ref()), &mut log),
            false => None,
        };
        let problems = log.into_problems();
        match case {
            Some(case) if problems.is_empty() => Ok(case),
            Some(_) | None => Err(CaseError::new(problems, source)),
        }
    }
}

/// Reads every table before giving up on any, so that all problems are found at once.
fn read_case(root: &Section<'_>, log: &mut Log<'_>) -> Option<Case> {
    let known: Vec<&str> = names(Heading::KEYS).chain(TABLES.iter().copied()).collect();
    root.check_keys(&known, &Others::NONE, log);
    let heading = Heading::read(root, log);
    let side = heading.as_ref().map_or(Side::Right, |heading| heading.side);
    let femur = Femur::read(&root.table("femur", log), side, log);
    let insert = Insert::read(&root.table("insert", log), side, log);
    let material = read_plain(root, "material", log);
    let contact = Contact::read(&root.table("contact", log), log);
    let machine = Machine::read(&root.table("machine", log), log);
    let wear = read_plain(root, "wear", log);
    let march = March::read(&root.table("march", log), log);
    let time = read_plain(root, "time", log);
    let accuracy = read_plain(root, "accuracy", log);
    Some(Case {
        heading: heading?,
        femur: femur?,
        insert: insert?,
        material: material?,
        contact: contact?,
        machine: machine?,
        wear: wear?,
        march: march?,
        time: time?,
        accuracy: accuracy?,
        origin: Origin::of(log.source()),
    })
}

/// Reads a table that holds nothing but the keys of `S`.
fn read_plain<S: Settings>(above: &Section<'_>, name: &str, log: &mut Log<'_>) -> Option<S> {
    let section = above.table(name, log);
    let known: Vec<&str> = names(S::KEYS).collect();
    section.check_keys(&known, &Others::NONE, log);
    S::read(&section, log)
}
