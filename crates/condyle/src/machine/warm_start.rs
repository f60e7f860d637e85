//! The warm start of an increment: what it did a cycle before, as far as it helps to solve it again.

use serde::{Deserialize, Serialize};

use super::{Kinematics, MachineState};

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
