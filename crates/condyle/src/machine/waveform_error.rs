//! Why knots make no waveform.

use thiserror::Error;

/// Why knots make no waveform.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WaveformError {
    /// No knot at all.
    #[error("the waveform has no points; give at least one")]
    Empty,
    /// A value or a place that is NaN or infinite.
    #[error("point {index} of the waveform is not a finite number; correct or remove it")]
    NotFinite {
        /// Which point, from 0.
        index: usize,
    },
    /// A place outside the cycle.
    #[error("point {index} of the waveform is at {percent} % of the cycle; use 0 to 100")]
    OutsideCycle {
        /// Which point, from 0.
        index: usize,
        /// Its place.
        percent: f64,
    },
    /// A place not after the one before.
    #[error(
        "point {index} of the waveform, at {percent} %, does not come after {before} %; sort the points and keep one for each place"
    )]
    NotIncreasing {
        /// Which point, from 0.
        index: usize,
        /// Its place.
        percent: f64,
        /// The place of the point before it.
        before: f64,
    },
    /// Samples too far apart.
    #[error(
        "the waveform has a gap from {from} % to {to} % of the cycle; add points between, at most {limit} % apart"
    )]
    Gap {
        /// Start of the gap, %.
        from: f64,
        /// End of the gap, %.
        to: f64,
        /// Longest distance allowed, %.
        limit: f64,
    },
    /// Different values at the two ends.
    #[error("the waveform steps at the seam: {first} at 0 % but {last} at 100 %; make them equal")]
    Seam {
        /// Value at 0 %.
        first: f64,
        /// Value at 100 %.
        last: f64,
    },
}
