//! A whole wear test, as the solver sees it.

use std::sync::Arc;

use crate::{
    contact::ContactLaw,
    creep::LeePienkowski,
    geometry::{FemoralSurface, Insert},
    machine::{Machine, TimeSettings},
    wear::{NamedLaw, WearLaw},
};

/// Bodies, activities and laws of a wear test; a right knee, mm N s MPa tonne rad.
///
/// It is a value: to change one, clone it, change the clone and march with that. Bodies and laws are shared
/// between clones, and a march leaves them as they are. Tests can be sent to other threads and run side by
/// side.
#[derive(Clone, Debug)]
pub struct WearTest {
    /// The femoral component.
    pub femur: Arc<FemoralSurface>,
    /// Axis about which the femur flexes, (x, y) in the femoral frame, mm.
    pub flexion_axis_mm: (f64, f64),
    /// Where the flexion axis starts over the insert before it settles, (x, z), mm.
    pub start_mm: (f64, f64),
    /// The unworn insert.
    pub insert: Arc<Insert>,
    /// The law of contact between femur and insert.
    pub contact: Arc<dyn ContactLaw>,
    /// What the machine does, one or more; the femur settles in the machine of the first.
    pub activities: Vec<Activity>,
    /// The law of wear.
    pub wear: Arc<dyn WearLaw>,
    /// Laws whose wear is told beside that of the law of wear; they move no surface.
    pub comparison_laws: Vec<NamedLaw>,
    /// The law of creep, if the insert creeps.
    pub creep: Option<LeePienkowski>,
    /// Density of the insert, mg/mm3.
    pub density_mg_per_mm3: f64,
    /// How finely and exactly a cycle is solved.
    pub time: TimeSettings,
    /// How the cycles are shared out.
    pub schedule: Schedule,
}

/// What the machine does over and over: walking, for instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Activity {
    /// Its name.
    pub name: String,
    /// The simulator with its inputs.
    pub machine: Machine,
    /// Its part of all cycles, 0 to 1; those of a test sum up to 1.
    pub share: f64,
}

impl Activity {
    /// The only activity of a test.
    pub fn only(name: &str, machine: Machine) -> Self {
        Self {
            name: name.to_owned(),
            machine,
            share: 1.0,
        }
    }

    /// The time that it takes of a mean cycle of its test, s.
    pub fn seconds(&self) -> f64 {
        self.share / self.machine.frequency_hz
    }
}

impl WearTest {
    /// How long a mean cycle of all activities takes, s.
    pub fn cycle_seconds(&self) -> f64 {
        self.activities.iter().map(Activity::seconds).sum()
    }

    /// The machine in which the femur settles: that of the first activity.
    ///
    /// # Panics
    /// A test without an activity.
    pub fn machine(&self) -> &Machine {
        &self.activities[0].machine
    }
}

/// The cycles of a test, and how often the geometry is brought up to date on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Gait cycles of the whole test.
    pub cycles: f64,
    /// When the geometry is updated.
    pub updates: Updates,
}

/// When the geometry is updated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Updates {
    /// So many times, each after the same number of cycles, as Knight 2007 does it; where the insert creeps, the first
    /// after a tenth of that, since most of creep comes at once.
    Fixed(usize),
    /// As seldom as the depth of wear allows.
    Auto {
        /// Largest error of the maximum depth that one interval may make, as a fraction of the
        /// depth expected at the end; greater than 0.
        tolerance: f64,
    },
}

impl Schedule {
    /// `updates` of the geometry, each after the same number of `cycles`.
    pub fn fixed(cycles: f64, updates: usize) -> Self {
        let updates = Updates::Fixed(updates);
        Self { cycles, updates }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::March;

    #[test]
    fn tests_and_marches_go_to_other_threads() {
        fn shared<T: Clone + Send + Sync>() {}
        fn sent<T: Send + Sync>() {}
        shared::<WearTest>();
        sent::<March>();
    }
}
