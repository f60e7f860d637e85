//! The definition of a wear test.

use std::sync::Arc;

use crate::{
    Vec3,
    contact::ContactLaw,
    creep::LeePienkowski,
    geometry::{Counterface, Insert},
    machine::{Axis, JointDescription, JointKind, Machine, TimeSettings},
    wear::{NamedLaw, WearLaw},
};

/// Bodies, activities and laws of a wear test; a right joint, mm N s MPa tonne rad.
///
/// A test is a value: to vary it, clone it and change the clone. Bodies and laws are shared between clones, and a
/// march does not change them. Tests can be sent to other threads and run in parallel.
#[derive(Clone, Debug)]
pub struct WearTest {
    /// The counterface.
    pub counterface: Arc<Counterface>,
    /// Flexion axis, (x, y) in the counterface frame, mm.
    pub flexion_axis_mm: (f64, f64),
    /// Position of the flexion axis over the insert before it settles, (x, z), mm.
    pub start_mm: (f64, f64),
    /// Height of the flexion axis at which the approach starts, mm; from above the insert if none. A head in a cup starts
    /// at the cup's centre, since the rim is in the way from above.
    pub start_height_mm: Option<f64>,
    /// The unworn insert.
    pub insert: Arc<Insert>,
    /// The law of contact between counterface and insert.
    pub contact: Arc<dyn ContactLaw>,
    /// The activities, one or more; the counterface settles in the machine of the first.
    pub activities: Vec<Activity>,
    /// The law of wear.
    pub wear: Arc<dyn WearLaw>,
    /// Laws that are evaluated for comparison only.
    pub comparison_laws: Vec<NamedLaw>,
    /// True if the wear by every law of powers is summed too, for the uncertainty of the law.
    pub law_family: bool,
    /// The law of creep, if the insert creeps.
    pub creep: Option<LeePienkowski>,
    /// Density of the insert, mg/mm3.
    pub density_mg_per_mm3: f64,
    /// Settings of the solution of a cycle.
    pub time: TimeSettings,
    /// Number of cycles, and of updates of the geometry.
    pub schedule: Schedule,
}

/// A repeated motion of the machine, such as walking.
#[derive(Clone, Debug, PartialEq)]
pub struct Activity {
    /// Name of the activity.
    pub name: String,
    /// The simulator with its inputs.
    pub machine: Machine,
    /// Its part of all cycles, 0 to 1; the shares of a test add up to 1.
    pub share: f64,
}

impl Activity {
    /// Creates the only activity of a test.
    pub fn only(name: &str, machine: Machine) -> Self {
        Self {
            name: name.to_owned(),
            machine,
            share: 1.0,
        }
    }

    /// Its part of the duration of a mean cycle, s.
    pub(super) fn seconds(&self) -> f64 {
        self.share / self.machine.frequency_hz
    }
}

impl WearTest {
    /// Returns the duration of a mean cycle of all activities, s.
    pub fn cycle_seconds(&self) -> f64 {
        self.activities.iter().map(Activity::seconds).sum()
    }

    /// Returns the machine of the first activity, in which the counterface settles.
    ///
    /// # Panics
    /// A test without an activity.
    pub fn machine(&self) -> &Machine {
        &self.activities[0].machine
    }

    /// Returns a message for the first value that its type permits and that no test can have.
    pub(super) fn invalid_value(&self) -> Option<String> {
        let shares = || self.activities.iter().map(|activity| activity.share);
        let total = shares().fold(0.0, |sum, share| sum + share);
        let is_part = |share: f64| (0.0..=1.0).contains(&share);
        // Shares in files are decimals, whose sum is rounded.
        let add_up = shares().all(is_part) && (total - 1.0).abs() < 1e-9;
        let has_updates = match self.schedule.updates {
            Updates::Fixed(updates) => updates > 0,
            Updates::Auto { tolerance } => tolerance > 0.0,
        };
        let (cycles, sides) = (self.schedule.cycles, self.insert.regions().count());
        let mut mechanisms = self
            .activities
            .iter()
            .map(|activity| activity.machine.mechanism);
        let mut joints = mechanisms.clone().flat_map(|mechanism| &mechanism.joints);
        let joint = joints.find_map(invalid_joint);
        let has_regions = mechanisms.all(|mechanism| [0, sides].contains(&mechanism.regions.len()));
        let checks = [
            (joint.is_none(), joint.unwrap_or_default()),
            (
                add_up,
                format!("the shares of its activities are not from 0 to 1, or add up to {total}"),
            ),
            (cycles > 0.0, format!("its number of cycles is {cycles}")),
            (has_updates, "it has no updates".to_owned()),
            (
                has_regions,
                format!("regions of the insert: {sides}; its mechanism has another number"),
            ),
        ];
        let mut failed = checks.into_iter().filter(|(is_met, _)| !is_met);
        failed.next().map(|(_, message)| message)
    }
}

/// Returns a message for a joint that no chain can have.
fn invalid_joint(joint: &JointDescription) -> Option<String> {
    let (Axis::Along(axis) | Axis::About(axis) | Axis::AboutCounterface(axis)) = joint.axis;
    let length = Vec3::from(axis).norm();
    if (length - 1.0).abs() > 1e-9 {
        return Some(format!(
            "the axis of the joint \"{}\" has the length {length}, not 1",
            joint.name
        ));
    }
    let is_turned = joint.is_zeroed && joint.kind() == JointKind::Rotation;
    is_turned.then(|| format!("the joint \"{}\" is zeroed, but rotates", joint.name))
}

/// The cycles of a test, and the updates of the geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Cycles of the whole test.
    pub cycles: f64,
    /// Times of the updates.
    pub updates: Updates,
}

/// The times at which the geometry is updated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Updates {
    /// A fixed number, each after the same number of cycles, as in Knight 2007; if the insert creeps, the first
    /// after a tenth of that, since most of creep comes at once.
    Fixed(usize),
    /// As few as the depth of wear allows.
    Auto {
        /// Largest error of the maximum depth by one interval, as a fraction of the
        /// depth expected at the end; greater than 0.
        tolerance: f64,
    },
}

impl Schedule {
    /// Creates a fixed number of updates over `cycles`.
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
