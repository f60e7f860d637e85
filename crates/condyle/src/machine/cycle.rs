//! A solved gait cycle.

use std::ops::Range;

use super::{CycleRow, MachineState, WarmStart};
use crate::contact::CycleHistory;

/// A solved cycle.
pub struct Cycle {
    /// One row an increment.
    pub rows: Vec<CycleRow>,
    /// What every node of the articulating surface went through.
    pub history: CycleHistory,
    /// Where the moments of each row are in it.
    pub instants: Vec<Range<usize>>,
    /// The machine when it was found to repeat itself.
    pub end: MachineState,
    /// How every increment was solved, for a next cycle like it.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// Increments solved until then.
    pub increments_solved: usize,
    /// Whether it did repeat itself, within the cycles that it was given.
    pub repeats: bool,
}

impl Cycle {
    /// The highest that a value which is never negative rises to.
    pub fn max(&self, value: fn(&CycleRow) -> f64) -> f64 {
        self.rows.iter().map(value).fold(0.0, f64::max)
    }
}
