//! How finely and how exactly a cycle is solved.

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
