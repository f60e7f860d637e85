//! How the cycles of a test are shared out between updates of the geometry.

/// The cycles of a test, and how often the geometry is brought up to date on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Gait cycles of the whole test.
    pub cycles: f64,
    /// When the geometry is updated.
    pub updates: Updates,
}

/// When the geometry is updated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Updates {
    /// So many times, each after the same number of cycles, as Knight 2007 does it; where the insert creeps, the first
    /// after a tenth of that, since most of creep comes at once.
    Fixed(usize),
    /// As seldom as the depth of wear allows.
    Auto {
        /// Largest error of the maximum depth that one interval may make, as a fraction of the
        /// depth expected at the end; greater than 0.
        tolerance: f64,
    },
}

impl Schedule {
    /// `updates` of the geometry, each after the same number of `cycles`.
    pub fn fixed(cycles: f64, updates: usize) -> Self {
        let updates = Updates::Fixed(updates);
        Self { cycles, updates }
    }
}
