//! The machine at an instant and over a solved gait cycle, the settings of the solution, and the reasons why a cycle
//! cannot be solved.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{CycleRow, Joint, JointKind, Machine};
use crate::contact::{CycleHistory, NotBorne};

/// Positions, rates and accelerations of the six joints, mm, rad and s, in the order of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kinematics {
    /// Positions, mm or rad.
    pub positions: [f64; 6],
    /// Rates, mm/s or rad/s.
    pub rates: [f64; 6],
    /// Accelerations, mm/s2 or rad/s2.
    pub accelerations: [f64; 6],
}

impl Kinematics {
    /// Joints that stand still at `positions`.
    pub fn at_rest(positions: [f64; 6]) -> Self {
        Self {
            positions,
            rates: [0.0; 6],
            accelerations: [0.0; 6],
        }
    }
}

/// The machine at an instant, with the memory of a two-step method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineState {
    /// Instant, in cycles.
    pub phase: f64,
    /// Motion at this instant.
    pub now: Kinematics,
    /// Motion one step earlier, and the length of that step in s; `None` after a start.
    pub before: Option<(Kinematics, f64)>,
}

impl MachineState {
    /// Creates a machine at rest at the start of a cycle, at the given positions where it is free.
    pub fn at_rest(machine: &Machine, positions: [f64; 6]) -> Self {
        let mut now = Kinematics::at_rest(positions);
        machine.drive(0.0, &mut now.positions, &mut now.rates);
        Self {
            phase: 0.0,
            now,
            before: None,
        }
    }

    /// Returns the positions `step_s` later at constant acceleration; after a start, which has no accelerations yet,
    /// at constant rate.
    pub(super) fn extrapolated(&self, step_s: f64) -> [f64; 6] {
        let now = &self.now;
        let half_s2 = if self.before.is_some() {
            0.5 * step_s * step_s
        } else {
            0.0
        };
        std::array::from_fn(|j| {
            now.positions[j] + step_s * now.rates[j] + half_s2 * now.accelerations[j]
        })
    }
}

/// Part of the step over which the present rates are extrapolated; the rest repeats the step of a cycle before.
///
/// A worn surface is rough by about 1 micrometre, and so two cycles differ by as much. Extrapolating over the whole
/// step would double that difference; not extrapolating at all would lag behind.
const COASTING: f64 = 0.5;

/// The solution of an increment, from which the same increment of the next cycle starts.
///
/// A cycle nearly repeats the previous one. With a warm start Newton's iteration starts nearer to the end of the
/// increment, and its contraction is known before the first correction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarmStart {
    /// Motion beyond the extrapolation over half of the step, mm or rad.
    lead: [f64; 6],
    /// Residual after the last whole correction over the square of the residual before it, 1/N: the contraction of
    /// Newton's iteration near the solution.
    pub contraction_per_n: f64,
}

impl WarmStart {
    pub(super) fn new(ended: &MachineState, contraction_per_n: f64) -> Self {
        let lead = ended.before.map_or([0.0; 6], |(from, step_s)| {
            let coasted = coasted(&from, step_s);
            std::array::from_fn(|j| ended.now.positions[j] - coasted[j])
        });
        Self {
            lead,
            contraction_per_n,
        }
    }

    /// Predicts the end of the same step from another start.
    pub(super) fn followed_from(&self, start: &Kinematics, step_s: f64) -> [f64; 6] {
        let coasted = coasted(start, step_s);
        std::array::from_fn(|j| coasted[j] + self.lead[j])
    }
}

fn coasted(from: &Kinematics, step_s: f64) -> [f64; 6] {
    std::array::from_fn(|j| from.positions[j] + COASTING * step_s * from.rates[j])
}

/// Counts of the solver's work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverCounters {
    /// Newton iterations: corrections of the positions.
    pub newton_iterations: u64,
    /// Contact evaluations; those of implicit steps include the tangent.
    pub contact_evaluations: u64,
    /// Steps that were rejected and halved.
    pub halvings: u64,
    /// Explicit steps.
    pub explicit_steps: u64,
    /// Largest inertia added by explicit steps, as a multiple of the machine's own.
    pub added_inertia: f64,
}

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
    /// True if Newton's iteration may stop at a correction whose predicted residual is within the tolerance,
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
    /// Returns the length of an increment at a cycle frequency, s.
    pub(crate) fn increment_s(&self, frequency_hz: f64) -> f64 {
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
            // Accelerations are not compared: they follow from positions, rates and loads.
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
    /// True if the cycle repeats within the permitted number of cycles.
    pub repeats: bool,
}

impl Cycle {
    /// Returns the largest value of any row; 0 if all are negative.
    pub fn max(&self, value: fn(&CycleRow) -> f64) -> f64 {
        self.rows.iter().map(value).fold(0.0, f64::max)
    }
}

/// Added inertia, as a multiple of the machine's own, beyond which it dominates the motion instead of the loads.
pub(crate) const HEAVY: f64 = 1.0;

/// The reason why a cycle was not solved.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CycleError {
    /// An increment that does not converge even in the smallest steps.
    #[error(
        "the machine finds no equilibrium at {percent:.2} % of the cycle: {residual_n:.3e} N remain unbalanced at {readings}; \
         check loads and springs there, or use more increments"
    )]
    NotConverged {
        percent: f64,
        readings: String,
        residual_n: f64,
    },
    /// Explicit steps that exceed all bounds or make energy.
    #[error(
        "explicit steps {how} at {percent:.2} % of the cycle, past {readings}{}; where friction rises steeply \
         with the speed or the load jumps, no step is short enough: use a larger slip_tolerance_mm_per_s, a shorter explicit_step_s, \
         or integrator = \"implicit\"",
        if *added_inertia > HEAVY {
            format!(", with {added_inertia:.0} times the machine's inertia added to it so that explicit_step_s is stable")
        } else {
            String::new()
        }
    )]
    Unstable {
        how: &'static str,
        percent: f64,
        readings: String,
        added_inertia: f64,
    },
    /// A load that the insert cannot bear.
    #[error("at {percent:.2} % of the cycle the load {why}")]
    NotBorne { percent: f64, why: NotBorne },
    /// A load under which the insert continues to flow or slip however often the step is solved.
    #[error(
        "load and insert do not settle at {percent:.2} % of the cycle, even in the smallest steps: each of {turns} iterations \
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_insert_that_tips_says_where_and_what_to_do() {
        let tipped = NotBorne::Tipped { moved_mm: 12.0 };
        let (percent, why) = (25.0, tipped);
        let message = CycleError::NotBorne { percent, why }.to_string();
        for words in [
            "at 25.00 % of the cycle the load tips the insert off its tray",
            "backside = \"bonded\"",
        ] {
            assert!(message.contains(words), "{message}");
        }
    }
}
