//! What an increment of the cycle did a cycle before, as far as it helps to solve it again.

use serde::{Deserialize, Serialize};

use super::{Kinematics, MachineState};

/// Part of the step that the rates before it are trusted for; the rest is as it was a cycle before.
///
/// A worn surface is rough by a thousandth of a millimetre, and so is what two cycles differ by:
/// to trust the rates for the whole step would double that, not to trust them at all would lag behind.
const COASTING: f64 = 0.5;

/// How an increment was solved.
///
/// A cycle nearly repeats the one before. So an increment starts nearer to its end, and knows how
/// much of a residual a correction leaves before it has made one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarmStart {
    /// How far the machine went beyond half of where its rates lead, mm or rad.
    lead: [f64; 6],
    /// What the last whole correction left of a residual, over its square, 1/N.
    pub contraction_per_n: f64,
}

impl WarmStart {
    /// That of a step that has just landed.
    pub(super) fn new(landed: &MachineState, contraction_per_n: f64) -> Self {
        let lead = landed.before.map_or([0.0; 6], |(from, step_s)| {
            let coasted = coasted(&from, step_s);
            std::array::from_fn(|j| landed.now.positions[j] - coasted[j])
        });
        Self {
            lead,
            contraction_per_n,
        }
    }

    /// Where the same step leads from another start.
    pub(super) fn followed_from(&self, start: &Kinematics, step_s: f64) -> [f64; 6] {
        let coasted = coasted(start, step_s);
        std::array::from_fn(|j| coasted[j] + self.lead[j])
    }
}

fn coasted(from: &Kinematics, step_s: f64) -> [f64; 6] {
    std::array::from_fn(|j| from.positions[j] + COASTING * step_s * from.rates[j])
}
