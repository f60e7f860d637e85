//! The machine at an instant, and what the solver remembers of it.

use serde::{Deserialize, Serialize};

use super::Machine;

/// Positions, rates and accelerations of the six joints, mm and rad and s, in the order of the chain.
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
    /// Joints that stand still.
    pub fn at_rest(positions: [f64; 6]) -> Self {
        Self {
            positions,
            rates: [0.0; 6],
            accelerations: [0.0; 6],
        }
    }
}

/// The machine at an instant, with what a two-step method remembers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineState {
    /// Instant, in cycles.
    pub phase: f64,
    /// Positions and rates now.
    pub now: Kinematics,
    /// Positions and rates one step ago, and how long that step was in s; none after a start.
    pub before: Option<(Kinematics, f64)>,
}

impl MachineState {
    /// A machine at rest at the start of a cycle, at the given positions where it is free.
    pub fn at_rest(machine: &Machine, positions: [f64; 6]) -> Self {
        let mut now = Kinematics::at_rest(positions);
        machine.drive(0.0, &mut now.positions, &mut now.rates);
        Self {
            phase: 0.0,
            now,
            before: None,
        }
    }

    /// Where the joints are `step_s` later if accelerations last; after a start, where there are none
    /// yet, if rates do.
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

/// Part of the step that the rates before it are trusted for; the rest is as it was a cycle before.
///
/// A worn surface is rough by a thousandth of a millimetre, and so is what two cycles differ by:
/// to trust the rates for the whole step would double that, not to trust them at all would lag behind.
const COASTING: f64 = 0.5;

/// How an increment was solved, and so how to start solving it a cycle later.
///
/// A cycle nearly repeats the one before. So Newton's iteration starts nearer to the end of the increment,
/// and knows how much of a residual a correction leaves before it has made one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarmStart {
    /// How far the machine went beyond half of where its rates lead, mm or rad.
    lead: [f64; 6],
    /// What the last whole correction left of a residual, over its square, 1/N: the contraction of
    /// Newton's iteration near the solution.
    pub contraction_per_n: f64,
}

impl WarmStart {
    /// That of a step that has just ended.
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

    /// Where the same step ends from another start, most likely.
    pub(super) fn followed_from(&self, start: &Kinematics, step_s: f64) -> [f64; 6] {
        let coasted = coasted(start, step_s);
        std::array::from_fn(|j| coasted[j] + self.lead[j])
    }
}

/// Where rates lead in a part of the step.
fn coasted(from: &Kinematics, step_s: f64) -> [f64; 6] {
    std::array::from_fn(|j| from.positions[j] + COASTING * step_s * from.rates[j])
}

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverCounters {
    /// Newton iterations: corrections of the positions.
    pub newton_iterations: u64,
    /// Contact evaluations, each with its tangent but for explicit steps.
    pub contact_evaluations: u64,
    /// Steps given up and tried in halves.
    pub halvings: u64,
    /// Explicit steps.
    pub explicit_steps: u64,
    /// Most inertia that explicit steps added, as a part of the machine's own.
    pub added_inertia: f64,
}
