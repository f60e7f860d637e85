//! A solved gait cycle, how finely it is solved, and when it repeats.

use std::ops::Range;

use super::{CycleRow, Joint, JointKind, Machine, MachineState, WarmStart};
use crate::contact::CycleHistory;

/// Settings of the march through the gait cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// Increments a cycle.
    pub increments: usize,
    /// An implicit increment is halved until its own error is estimated below this, mm; rotations on
    /// a lever of 10 mm. 0 takes every increment in one step.
    pub increment_error_mm: f64,
    /// Largest force left out of balance, N; for moments, this much on a lever of 10 mm.
    pub force_tolerance_n: f64,
    /// Whether Newton's iteration may stop at a correction that leaves no more than that, as predicted
    /// from its convergence, and not compute what is left.
    pub trusts_prediction: bool,
    /// A cycle counts once its end lies this near to its start, mm ...
    pub repeat_tolerance_mm: f64,
    /// ... and this near, rad.
    pub repeat_tolerance_rad: f64,
    /// Cycles to wait for one that repeats itself.
    pub most_cycles_to_repeat: usize,
    /// How one increment is stepped through.
    pub integration: Integration,
}

impl TimeSettings {
    /// The same with cycles that repeat themselves within a part of the tolerances.
    pub fn repeating_within(self, part: f64) -> Self {
        Self {
            repeat_tolerance_mm: part * self.repeat_tolerance_mm,
            repeat_tolerance_rad: part * self.repeat_tolerance_rad,
            ..self
        }
    }

    /// Length of an increment at so many cycles a second, s.
    pub fn increment_s(&self, frequency_hz: f64) -> f64 {
        1.0 / (frequency_hz * self.increments as f64)
    }
}

/// How an increment is stepped through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Second-order backward differences and Newton's iteration, one step an increment.
    Implicit,
    /// Central differences in as many stable steps as an increment takes.
    Explicit {
        /// Inertia is added wherever the stable step is shorter than this, s; 0 adds none.
        least_step_s: f64,
    },
}

impl Default for TimeSettings {
    fn default() -> Self {
        Self {
            increments: 200,
            increment_error_mm: 0.0,
            force_tolerance_n: 1e-2,
            trusts_prediction: true,
            repeat_tolerance_mm: 1e-2,
            repeat_tolerance_rad: 0.01f64.to_radians(),
            most_cycles_to_repeat: 10,
            integration: Integration::Implicit,
        }
    }
}

/// A solved cycle.
pub struct Cycle {
    /// One row an increment.
    pub rows: Vec<CycleRow>,
    /// What every node of the articulating surface went through.
    pub history: CycleHistory,
    /// Where the moments of each row are in it.
    pub instants: Vec<Range<usize>>,
    /// The machine when it was found to repeat itself.
    pub end: MachineState,
    /// How every increment was solved, for a next cycle like it.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// Increments solved until then.
    pub increments_solved: usize,
    /// Whether it did repeat itself, within the cycles that it was given.
    pub repeats: bool,
}

impl Cycle {
    /// The highest that a value which is never negative rises to.
    pub fn max(&self, value: fn(&CycleRow) -> f64) -> f64 {
        self.rows.iter().map(value).fold(0.0, f64::max)
    }
}

/// What counts as the same motion again.
pub(super) struct Repetition<'a> {
    machine: &'a Machine,
    time: &'a TimeSettings,
    /// Rates count by how far they lead in this time, s.
    lead_s: f64,
}

impl<'a> Repetition<'a> {
    /// Repetition within the tolerances of `time`; rates count by how far they lead in an increment.
    pub fn new(machine: &'a Machine, time: &'a TimeSettings) -> Self {
        let lead_s = time.increment_s(machine.frequency_hz);
        Self {
            machine,
            time,
            lead_s,
        }
    }

    /// Whether the machine is where it was at `earlier` and moves as it did.
    pub fn is_met(&self, state: &MachineState, earlier: &MachineState) -> bool {
        let repeats = |(j, joint): (usize, &Joint)| {
            let apart = (state.now.positions[j] - earlier.now.positions[j]).abs();
            let parting = (state.now.rates[j] - earlier.now.rates[j]).abs() * self.lead_s;
            apart.max(parting) <= self.tolerance(joint)
        };
        self.machine.joints.iter().enumerate().all(repeats)
    }

    /// How far apart two positions of a joint may be, mm or rad.
    fn tolerance(&self, joint: &Joint) -> f64 {
        match joint.description.kind() {
            JointKind::Rotation => self.time.repeat_tolerance_rad,
            JointKind::Translation => self.time.repeat_tolerance_mm,
        }
    }
}
