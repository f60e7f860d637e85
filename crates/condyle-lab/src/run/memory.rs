//! How much memory a run needs, from what it counts.

use condyle::{evolve::March, geometry::FemoralSurface};
use condyle_io::case::Case;

use super::error::RunError;
use crate::at_rest::AtRest;

/// What the program takes whatever the case, MB.
const PROGRAM_MB: f64 = 6.0;
/// Bytes of a node of the insert: positions now and on the way, and what a file of it takes while it is written.
const BYTES_A_NODE: f64 = 800.0;
/// Bytes of a touched node at an increment: the history of the cycle, and of the other cycle beside it.
const BYTES_A_TOUCH: f64 = 120.0;
/// The estimate of the error keeps a history of twice the increments beside.
const WITH_ESTIMATE: f64 = 2.5;
/// What the field of a mesh femur takes while it is made, MB.
const FIELD_MB: f64 = 12.0;

/// Memory that a march of `case` needs at its highest, about, MB.
pub(crate) fn memory_mb(case: &Case, march: &March) -> f64 {
    let nodes = march.insert().mesh().nodes.len() as f64;
    let touched = AtRest::of(march).touched.len() as f64;
    let touches = touched * march.test().time.increments as f64;
    let histories = if case.accuracy.estimate {
        WITH_ESTIMATE
    } else {
        1.0
    };
    let field_mb = match march.femur() {
        FemoralSurface::Mesh(_) => FIELD_MB,
        _ => 0.0,
    };
    let counted = BYTES_A_NODE * nodes + BYTES_A_TOUCH * histories * touches;
    PROGRAM_MB + field_mb + 1e-6 * counted
}

/// Refuses a march that would need more memory than its case allows.
///
/// # Errors
/// [`RunError::Memory`].
pub(super) fn check_memory(case: &Case, march: &March) -> Result<(), RunError> {
    let (needed_gb, allowed_gb) = (1e-3 * memory_mb(case, march), case.limits.memory_gb);
    if needed_gb <= allowed_gb {
        return Ok(());
    }
    Err(RunError::memory(case, needed_gb))
}
