//! The machine at an instant.

use serde::{Deserialize, Serialize};

use super::{Kinematics, Machine};

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
