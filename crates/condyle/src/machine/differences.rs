//! Second-order backward differences (BDF2).

use super::{Kinematics, Machine, MachineState, balance::StepSlopes};

/// The weights of the backward differences: rate = slope q + weights on what was before.
pub(super) struct BackwardDifferences {
    slope: f64,
    now: f64,
    before: f64,
}

impl BackwardDifferences {
    /// Those of a step of `step_s` from a state; second order where the state knows the one before it,
    /// first order after a start.
    pub fn from(state: &MachineState, step_s: f64) -> Self {
        let ratio = state.before.map_or(0.0, |(_, last_s)| step_s / last_s);
        Self {
            slope: (1.0 + 2.0 * ratio) / (1.0 + ratio) / step_s,
            now: -(1.0 + ratio) / step_s,
            before: ratio * ratio / (1.0 + ratio) / step_s,
        }
    }

    /// How rates and accelerations at the end of the step follow the positions there.
    pub fn slopes(&self) -> StepSlopes {
        StepSlopes {
            rate: self.slope,
            acceleration: self.slope.powi(2),
        }
    }

    /// Rate of a value at the end of the step from what it is there, was at the start and was before.
    fn rate(&self, end: f64, now: f64, before: Option<f64>) -> f64 {
        self.slope * end + (self.now * now + before.map_or(0.0, |before| self.before * before))
    }

    /// Joints at the end of the step, at `phase`, where they are at `positions` unless they are driven.
    pub fn kinematics(
        &self,
        machine: &Machine,
        state: &MachineState,
        mut positions: [f64; 6],
        phase: f64,
    ) -> Kinematics {
        let (now, before) = (&state.now, state.before.as_ref().map(|(before, _)| before));
        let mut rates = std::array::from_fn(|j| {
            let before = before.map(|before| before.positions[j]);
            self.rate(positions[j], now.positions[j], before)
        });
        machine.drive(phase, &mut positions, &mut rates);
        let accelerations = std::array::from_fn(|j| {
            let before = before.map(|before| before.rates[j]);
            self.rate(rates[j], now.rates[j], before)
        });
        Kinematics {
            positions,
            rates,
            accelerations,
        }
    }
}
