//! The run that the numbers of the catalogue are computed from.

use condyle::{
    evolve::{CyclePeaks, March, MarchState, UpdateRecord},
    machine::{CycleRow, TestedJoint, knee::KNEE},
};

/// Properties of a run that are not part of its march.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunFacts {
    /// Wear of cross-linked relative to conventional polyethylene; `None` for a conventional insert.
    pub wear_over_conventional: Option<f64>,
    /// Largest difference of the peak pressure from that of the deformable insert that the pressure law was fitted to,
    /// %; none where the case does not give it.
    pub pressure_law_peak_error_percent: Option<f64>,
    /// Time of the solver, s.
    pub wall_s: f64,
}

/// A run that is done.
#[derive(Clone, Copy)]
pub struct FinishedRun<'a> {
    /// The march after its last update.
    pub march: &'a March,
    /// Properties that are not part of the march.
    pub facts: RunFacts,
    /// The first update.
    pub first: &'a UpdateRecord,
    /// The last update.
    pub last: &'a UpdateRecord,
    /// Extremes of the cycle on the worn surface.
    pub final_cycle: CyclePeaks,
    /// Increments of the first cycle of the first activity.
    pub first_cycle: &'a [CycleRow],
}

impl<'a> FinishedRun<'a> {
    /// The run of `march`; none before it is done.
    pub fn new(march: &'a March, facts: RunFacts) -> Option<Self> {
        let state = march.state();
        Some(Self {
            march,
            facts,
            first: state.updates.first()?,
            last: state.updates.last()?,
            final_cycle: state.final_cycle?,
            first_cycle: &state.activities.first()?.first_and_last.as_ref()?.0.rows,
        })
    }

    /// Returns the tested joint; `None` for another mechanism.
    pub fn joint(&self) -> Option<TestedJoint> {
        let mechanism = self.march.test().machine().mechanism;
        // The results of knees are those of the joints of the simulator of knees.
        (mechanism.tests != TestedJoint::Knee || *mechanism == KNEE).then_some(mechanism.tests)
    }

    /// The state of the march.
    pub fn state(&self) -> &'a MarchState {
        self.march.state()
    }

    /// Returns the extremes of all solved cycles with the cycles done before each: those of the updates, then the
    /// final one.
    pub fn peaks(&self) -> impl DoubleEndedIterator<Item = (f64, CyclePeaks)> {
        let state = self.state();
        let updates = state.updates.iter().enumerate();
        let solved = updates.map(|(number, update)| (state.cycles_before(number), update.peaks));
        solved.chain([(self.last.cycles, self.final_cycle)])
    }
}

/// Returns the one with the largest `value` of extremes with the cycles done before each; of equals the first, not the last as
/// `max_by` does.
pub(super) fn largest<T>(
    extremes: impl Iterator<Item = (f64, T)>,
    value: fn(&T) -> f64,
) -> Option<(f64, T)> {
    extremes.reduce(|largest, own| {
        if value(&own.1) > value(&largest.1) {
            own
        } else {
            largest
        }
    })
}
