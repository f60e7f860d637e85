//! All that a case says.

use super::activity::Activities;
use super::contact::Contact;
use super::femur::Femur;
use super::femur::FemurPlacement;
use super::frame::Heading;
use super::insert::Insert;
use super::insert::InsertPlacement;
use super::machine::Machine;
use super::material::Creep;
use super::material::Material;
use super::run_options::Accuracy;
use super::run_options::Limits;
use super::run_options::Output;
use super::schedule::March;
use super::schedule::Time;
use super::wear::Wear;
use crate::config::Source;
use std::sync::Arc;

/// A wear test as its file describes it, checked, with every default filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Title and side.
    pub heading: Heading,
    /// The femoral component.
    pub femur: Femur,
    /// How it sits on its bone.
    pub femur_placement: FemurPlacement,
    /// The tibial insert.
    pub insert: Insert,
    /// How it sits in its holder.
    pub insert_placement: InsertPlacement,
    /// Polyethylene of the insert.
    pub material: Material,
    /// Pressure law and friction.
    pub contact: Contact,
    /// The simulator.
    pub machine: Machine,
    /// What it does in turn; where there is none, what the machine's own waveforms say.
    pub activities: Activities,
    /// The wear law.
    pub wear: Wear,
    /// The law of creep.
    pub creep: Creep,
    /// The march over the life of the insert.
    pub march: March,
    /// Steps and tolerances in time.
    pub time: Time,
    /// What a run tells of its own accuracy.
    pub accuracy: Accuracy,
    /// What a run may take of the computer.
    pub limits: Limits,
    /// What a run writes besides what it always does.
    pub output: Output,
    pub(super) origin: Origin,
}

/// The text of a case file, and what of it was left out.
///
/// All origins are equal: two cases are the same if they say the same, wherever they stand.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    /// The text.
    pub(super) source: Source,
    /// Constants that a law chosen from outside does not have.
    pub(super) left_out: Vec<LeftOutConstant>,
}

impl Origin {
    pub(super) fn of(source: &Source) -> Self {
        Self {
            source: Arc::clone(source),
            left_out: Vec::new(),
        }
    }
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A constant of the file that the law chosen from outside does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LeftOutConstant {
    /// As the file writes it.
    pub(super) written: String,
    /// The law chosen from outside.
    pub(super) law: &'static str,
}
