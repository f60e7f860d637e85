//! Why a march ended early.

use thiserror::Error;

use super::PlacementError;
use crate::machine::CycleError;

/// Why a march ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MarchError {
    /// The bodies make no knee.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A cycle was not solved.
    #[error("update {update}, after {cycles:.0} cycles: {source}")]
    Cycle {
        /// Which update, from 1.
        update: usize,
        /// Cycles done before it.
        cycles: f64,
        /// Why.
        source: CycleError,
    },
    /// The femur fell off the insert.
    #[error(
        "update {update}: the femur touches the insert zero_vector in the whole cycle, and ends it at AP {ap_mm:.1} mm; \
         check loads, springs, axes and start_mm"
    )]
    LostContact {
        /// Which update, from 1.
        update: usize,
        /// AP at the end of the cycle.
        ap_mm: f64,
    },
    /// The insert wore through.
    #[error(
        "update {update}: the insert is worn through at ({x:.1}, {z:.1}) mm; use fewer cycles or a thicker insert"
    )]
    WornThrough {
        /// Which update, from 1.
        update: usize,
        /// Place along x.
        x: f64,
        /// Place along z.
        z: f64,
    },
}
