//! The run that the numbers of the catalogue are computed from.

use condyle::{
    evolve::{March, MarchState, UpdateRecord},
    machine::{CycleRow, TestedJoint, knee::KNEE},
};

/// Properties of a run that its march does not have.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunFacts {
    /// Wear of cross-linked over conventional polyethylene; none of a conventional insert.
    pub wear_over_conventional: Option<f64>,
    /// Largest difference of the peak pressure from that of the deformable insert that the pressure law was fitted to,
    /// %; none where the case does not give it.
    pub pressure_law_peak_error_percent: Option<f64>,
    /// Time of the solver, s.
    pub wall_s: f64,
}

/// A run with at least one update.
#[derive(Clone, Copy)]
pub struct FinishedRun<'a> {
    /// The march after its last update.
    pub march: &'a March,
    /// Properties that the march does not have.
    pub facts: RunFacts,
    /// The first update.
    pub first: &'a UpdateRecord,
    /// The last update.
    pub last: &'a UpdateRecord,
    /// Increments of the first cycle of the first activity.
    pub first_cycle: &'a [CycleRow],
}

impl<'a> FinishedRun<'a> {
    /// The run of `march`; none before its first update.
    pub fn new(march: &'a March, facts: RunFacts) -> Option<Self> {
        let state = march.state();
        Some(Self {
            march,
            facts,
            first: state.updates.first()?,
            last: state.updates.last()?,
            first_cycle: &state.activities.first()?.first_and_last.as_ref()?.0.rows,
        })
    }

    /// The joint; none of another mechanism.
    pub fn joint(&self) -> Option<TestedJoint> {
        let mechanism = self.march.test().machine().mechanism;
        // The results of knees are those of the joints of the simulator of knees.
        (mechanism.tests != TestedJoint::Knee || *mechanism == KNEE).then_some(mechanism.tests)
    }

    /// The state of the march.
    pub fn state(&self) -> &'a MarchState {
        self.march.state()
    }

    /// The number and record of the first update with the largest `value`.
    pub fn largest(&self, value: fn(&UpdateRecord) -> f64) -> (usize, &'a UpdateRecord) {
        let updates = self.state().updates.iter().enumerate();
        // Strictly larger, so that of equal updates the first counts; `max_by` would return the last.
        updates.fold((0, self.first), |largest, update| {
            if value(update.1) > value(largest.1) {
                update
            } else {
                largest
            }
        })
    }
}
