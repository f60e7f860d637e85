//! The machine at an instant, and the solver's memory of it.

use serde::{Deserialize, Serialize};

use super::Machine;

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
