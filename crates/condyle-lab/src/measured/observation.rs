//! A measured rate as a fit sees it.

/// A measured rate, and what its scatter tells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Observation {
    /// The rate.
    pub(super) rate: f64,
    /// How much it counts: the number of specimens, or the spread of the weighings in time.
    pub(super) weight: f64,
    /// Sum of squares of what it is the mean or the line of, each from it, in the square of the rate's unit.
    pub(super) squares: f64,
    /// How many of these squares are free.
    pub(super) freedom: usize,
}
