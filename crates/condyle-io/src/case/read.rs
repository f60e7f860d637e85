//! A case from its file, table by table.

use super::contact::Contact;
use super::contents::Case;
use super::femur::Femur;
use super::heading::{Heading, Side};
use super::insert::Insert;
use super::machine::Machine;
use super::march::March;
use super::origin::Origin;
use super::wear::{Wear, WearLaws};
use crate::keyed::{Log, Section, Settings, names, read_table};

/// Every table of a case, in the order they are written.
const TABLES: [&str; 10] = [
    "femur", "insert", "material", "contact", "machine", "wear", "march", "time", "accuracy",
    "output",
];

/// Reads every table before giving up on any, so that all problems are found at once.
pub(super) fn read_case(
    root: &Section<'_>,
    wear_laws: WearLaws,
    log: &mut Log<'_>,
) -> Option<Case> {
    let known: Vec<&str> = names(&Heading::keys()).chain(TABLES).collect();
    root.check_keys(&known, log);
    let heading = Heading::read(root, log);
    let side = heading.as_ref().map_or(Side::Right, |heading| heading.side);
    let femur = Femur::read_checked(&root.table("femur", log), side, log);
    let insert = Insert::read_checked(&root.table("insert", log), side, log);
    let material = read_table(root, "material", log);
    let contact = Contact::read(&root.table("contact", log), log);
    let machine = Machine::read(&root.table("machine", log), log);
    let wear = Wear::read(&root.table("wear", log), wear_laws, log);
    let march = March::read(&root.table("march", log), log);
    let time = read_table(root, "time", log);
    let accuracy = read_table(root, "accuracy", log);
    let output = read_table(root, "output", log);
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
        output: output?,
        origin: Origin::of(log.source()),
    })
}
