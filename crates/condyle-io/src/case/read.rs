//! A case from its file, table by table.

use super::activity::{self, Activities};
use super::contact::Contact;
use super::contents::Case;
use super::contents::Origin;
use super::femur::Femur;
use super::femur::FemurPlacement;
use super::frame::{Heading, Side};
use super::insert::Insert;
use super::insert::InsertPlacement;
use super::machine::Machine;
use super::material::Creep;
use super::material::Material;
use super::schedule::March;
use super::wear::{Wear, WearLaws};
use crate::config::{Log, Section, Settings, Variants, names, read_table};

/// Every table of a case, in the order they are written.
const TABLES: [&str; 13] = [
    "femur",
    "insert",
    "material",
    "contact",
    "machine",
    activity::TABLE,
    "wear",
    "creep",
    "march",
    "time",
    "accuracy",
    "limits",
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
    let section = root.table("femur", log);
    let femur = Femur::read_checked(&section, side, log);
    let femur_placement = FemurPlacement::read_checked(&section, femur.as_ref(), log);
    let section = root.table("insert", log);
    let insert = Insert::read_checked(&section, side, log);
    let insert_placement = InsertPlacement::read_checked(&section, insert.as_ref(), log);
    let material = Material::read(&root.table("material", log), log);
    let contact = Contact::read(&root.table("contact", log), log);
    let has_activities = root.value(activity::TABLE).is_some();
    let machine = Machine::read(&root.table("machine", log), has_activities, log);
    let activities = Activities::read(root, machine.as_ref(), log);
    let wear = Wear::read(&root.table("wear", log), wear_laws, log);
    let creep = Creep::read(&root.table("creep", log), &[], log);
    let march = March::read(&root.table("march", log), log);
    let time = read_table(root, "time", log);
    let accuracy = read_table(root, "accuracy", log);
    let limits = read_table(root, "limits", log);
    let output = read_table(root, "output", log);
    Some(Case {
        heading: heading?,
        femur: femur?,
        femur_placement: femur_placement?,
        insert: insert?,
        insert_placement: insert_placement?,
        material: material?,
        contact: contact?,
        machine: machine?,
        activities: activities?,
        wear: wear?,
        creep: creep?,
        march: march?,
        time: time?,
        accuracy: accuracy?,
        limits: limits?,
        output: output?,
        origin: Origin::of(log.source()),
    })
}
