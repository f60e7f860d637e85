//! A case from its file, table by table.

use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;

use super::contact::Contact;
use super::contents::Case;
use super::femur::Femur;
use super::heading::{Heading, Side};
use super::insert::Insert;
use super::machine::Machine;
use super::march::March;
use super::origin::Origin;
use crate::keyed::{
    Log, Problems, Section, Settings, Source, names, read_document, read_source, read_table,
};

/// Every table of a case, in the order they are written.
const TABLES: [&str; 9] = [
    "femur", "insert", "material", "contact", "machine", "wear", "march", "time", "accuracy",
];

impl Case {
    /// Reads the case file at `path`; paths in it count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with it, or that it cannot be read.
    pub fn read(path: &Path) -> Result<Self, Problems> {
        let source = read_source(path).map_err(Problems::unreadable)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_source(&source, folder)
    }

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, Problems> {
        let source = Arc::new(NamedSource::new(name, text.to_owned()));
        Self::from_source(&source, folder)
    }

    pub(super) fn from_source(source: &Source, folder: &Path) -> Result<Self, Problems> {
        read_document(source, folder, read_case)
    }
}

/// Reads every table before giving up on any, so that all problems are found at once.
fn read_case(root: &Section<'_>, log: &mut Log<'_>) -> Option<Case> {
    let known: Vec<&str> = names(&Heading::keys()).chain(TABLES).collect();
    root.check_keys(&known, log);
    let heading = Heading::read(root, log);
    let side = heading.as_ref().map_or(Side::Right, |heading| heading.side);
    let femur = Femur::read_checked(&root.table("femur", log), side, log);
    let insert = Insert::read_checked(&root.table("insert", log), side, log);
    let material = read_table(root, "material", log);
    let contact = Contact::read(&root.table("contact", log), log);
    let machine = Machine::read(&root.table("machine", log), log);
    let wear = read_table(root, "wear", log);
    let march = March::read(&root.table("march", log), log);
    let time = read_table(root, "time", log);
    let accuracy = read_table(root, "accuracy", log);
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
