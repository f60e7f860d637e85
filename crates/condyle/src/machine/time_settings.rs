//! How finely and how exactly a cycle is solved.

/// Settings of the march through the gait cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// Increments a cycle.
    pub increments: usize,
    /// Largest force left out of balance, N; for moments, this much on a lever of 10 mm.
    pub force_tolerance_n: f64,
    /// A cycle counts once its end lies this near to its start, mm ...
    pub repeat_tolerance_mm: f64,
    /// ... and this near, rad.
    pub repeat_tolerance_rad: f64,
    /// Cycles to wait for one that repeats itself.
    pub most_cycles_to_repeat: usize,
}

impl Default for TimeSettings {
    fn default() -> Self {
        Self {
            increments: 200,
            force_tolerance_n: 1e-2,
            repeat_tolerance_mm: 1e-2,
            repeat_tolerance_rad: 0.01f64.to_radians(),
            most_cycles_to_repeat: 10,
        }
    }
}
