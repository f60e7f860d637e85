//! How the cycles of a test are shared out between updates of the geometry.

/// A march by a fixed interval, as Knight 2007 does it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Gait cycles of the whole test.
    pub cycles: f64,
    /// Updates of the geometry, each after the same number of cycles.
    pub updates: usize,
}

impl Schedule {
    /// Cycles between two updates.
    pub fn interval(&self) -> f64 {
        self.cycles / self.updates as f64
    }
}
