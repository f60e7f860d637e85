//! A solved gait cycle, the settings of its solution, and the reasons why a cycle cannot be solved.

use std::ops::Range;

use thiserror::Error;

use super::{CycleRow, Joint, JointKind, Machine, MachineState, WarmStart};
use crate::contact::{CycleHistory, NotBorne};

/// Settings of the solution of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// Increments per cycle.
    pub increments: usize,
    /// An implicit increment is halved until its estimated error is below this, mm; rotations on
    /// a lever of 10 mm. 0 takes every increment in one step.
    pub increment_error_mm: f64,
    /// Largest force left out of balance, N; moments count as forces on a lever of 10 mm.
    pub force_tolerance_n: f64,
    /// Whether Newton's iteration may stop at a correction whose predicted residual is within the tolerance,
    /// without evaluating that residual.
    pub trusts_prediction: bool,
    /// Largest difference in translation between the ends of a cycle that counts as repeating, mm.
    pub repeat_tolerance_mm: f64,
    /// Largest difference in rotation between the ends of such a cycle, rad.
    pub repeat_tolerance_rad: f64,
    /// Largest number of cycles solved until one repeats.
    pub most_cycles_to_repeat: usize,
    /// Method of the time integration.
    pub integration: Integration,
}

impl TimeSettings {
    /// Scales the tolerances of the repetition by `part`.
    pub(crate) fn repeating_within(self, part: f64) -> Self {
        Self {
            repeat_tolerance_mm: part * self.repeat_tolerance_mm,
            repeat_tolerance_rad: part * self.repeat_tolerance_rad,
            ..self
        }
    }

    /// Returns the length of an increment at a cycle frequency, s.
    pub fn increment_s(&self, frequency_hz: f64) -> f64 {
        1.0 / (frequency_hz * self.increments as f64)
    }

    /// Returns whether a machine is where it was at an earlier state and moves as it did then.
    pub(super) fn is_repeated(
        &self,
        machine: &Machine,
        state: &MachineState,
        earlier: &MachineState,
    ) -> bool {
        // Rates differ by as much as they move the joints apart within an increment.
        let lead_s = self.increment_s(machine.frequency_hz);
        let repeats = |(j, joint): (usize, &Joint)| {
            let apart = (state.now.positions[j] - earlier.now.positions[j]).abs();
            let parting = (state.now.rates[j] - earlier.now.rates[j]).abs() * lead_s;
            let tolerance = match joint.description.kind() {
                JointKind::Rotation => self.repeat_tolerance_rad,
                JointKind::Translation => self.repeat_tolerance_mm,
            };
            apart.max(parting) <= tolerance
        };
        machine.joints.iter().enumerate().all(repeats)
    }
}

/// Method of the time integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Second-order backward differences and Newton's iteration, one step per increment.
    Implicit,
    /// Central differences in as many stable steps as an increment requires.
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
#[non_exhaustive]
pub struct Cycle {
    /// One row per increment.
    pub rows: Vec<CycleRow>,
    /// Pressure and slip of every node of the articulating surface.
    pub history: CycleHistory,
    /// Range of each row's moments in the history.
    pub instants: Vec<Range<usize>>,
    /// State of the machine at the end.
    pub end: MachineState,
    /// Solutions of the increments, for the next cycle.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// Increments solved in all.
    pub increments_solved: usize,
    /// Whether the cycle repeats within the permitted number of cycles.
    pub repeats: bool,
}

impl Cycle {
    /// Returns the largest value of any row; 0 if all are negative.
    pub fn max(&self, value: fn(&CycleRow) -> f64) -> f64 {
        self.rows.iter().map(value).fold(0.0, f64::max)
    }
}

/// The reason why a cycle was not solved.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CycleError {
    /// An increment that does not converge even in the smallest steps.
    #[error(
        "the machine finds no balance at {percent:.2} % of the cycle: {residual_n:.3e} N are left over at {readings}; \
         check loads and springs there, or use more increments"
    )]
    NotConverged {
        percent: f64,
        readings: String,
        residual_n: f64,
    },
    /// Explicit steps whose rates exceed all bounds.
    #[error(
        "explicit steps leave all bounds at {percent:.2} % of the cycle, past {readings}; where friction rises steeply \
         with the speed or the load jumps no step is short enough: take a larger slip_tolerance_mm_per_s, a shorter explicit_step_s, or \
         integrator = \"implicit\""
    )]
    Unstable { percent: f64, readings: String },
    /// A load that presses the insert flat.
    #[error(
        "the load presses the insert flat at {percent:.2} % of the cycle: where plastic strain has come to {plastic_strain:.2} the \
         insert finds no balance; check the load, and [contact.deformable] yield_stress_mpa and its hardening, or take plasticity = \"none\""
    )]
    Flattened { percent: f64, plastic_strain: f64 },
    /// A load that tips an insert resting on its tray.
    #[error(
        "the load tips the insert off its tray at {percent:.2} % of the cycle: its backside finds no rest, and had moved by \
         {moved_mm:.2e} mm when the search was given up; check whether the load lies within the tray, or take [contact] \
         backside = \"bonded\""
    )]
    Tipped { percent: f64, moved_mm: f64 },
    /// A load under which the insert continues to flow or slip however often the step is solved.
    #[error(
        "load and insert do not settle at {percent:.2} % of the cycle, even in the smallest steps: each of {turns} turns \
         moved the surface again; use more increments, or check the load there"
    )]
    Unsettled { percent: f64, turns: u32 },
    /// A loaded joint without inertia under the explicit integrator.
    #[error(
        "the explicit integrator needs inertia on every loaded freedom, and {joint} has none; give it some, or \
         take the implicit integrator"
    )]
    NoInertia { joint: &'static str },
}

impl CycleError {
    /// Converts a load that the insert cannot bear, at a phase of the cycle, to an error.
    pub(super) fn not_borne(phase: f64, why: NotBorne) -> Self {
        let percent = 100.0 * phase;
        match why {
            NotBorne::Flattened { plastic_strain } => Self::Flattened {
                percent,
                plastic_strain,
            },
            NotBorne::Tipped { moved_mm } => Self::Tipped { percent, moved_mm },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_insert_that_tips_says_where_and_what_to_do() {
        let tipped = NotBorne::Tipped { moved_mm: 12.0 };
        let message = CycleError::not_borne(0.25, tipped).to_string();
        for words in [
            "tips the insert off its tray at 25.00 %",
            "backside = \"bonded\"",
        ] {
            assert!(message.contains(words), "{message}");
        }
    }
}
