//! How much memory a run needs, from what it counts.

use condyle::{
    evolve::March,
    geometry::FemoralSurface,
    machine::{Drive, knee::IS},
};
use condyle_io::case::{Case, Limits};

use super::error::RunError;
use crate::at_rest::AtRest;

/// What the program takes whatever the case, MB.
const PROGRAM_MB: f64 = 6.0;
/// Bytes of a touched node at an increment: the histories of a cycle and of the one before.
const BYTES_A_TOUCH: f64 = 230.0;
/// The estimate of the error keeps histories of twice the increments beside them.
const WITH_ESTIMATE: f64 = 2.1;
/// To so many times the nodes that it is near at rest the femur comes near in the life of an insert, about.
const EVER_NEAR: f64 = 4.0;
/// Parts of a cycle at which the load is looked at.
const LOOKED_AT: usize = 50;

/// Memory that a march of `case` needs at its highest, about, MB.
pub(crate) fn memory_mb(case: &Case, march: &March, at_rest: &AtRest) -> f64 {
    // The area of a contact on a foundation goes with the root of its load.
    let larger = (mean_load_n(march) / at_rest.axial_force_n).max(1.0).sqrt();
    let most = march.insert().surface_nodes().len() as f64;
    let touched = (at_rest.touched.len() as f64 * larger).min(most);
    memory_mb_touching(case, march, touched, EVER_NEAR * at_rest.nodes_near as f64)
}

/// The same if so many nodes touch at an increment, and the femur ever comes near so many.
fn memory_mb_touching(case: &Case, march: &March, nodes_touched: f64, nodes_near: f64) -> f64 {
    let histories = if case.accuracy.estimate {
        WITH_ESTIMATE
    } else {
        1.0
    };
    let touches = nodes_touched * march.test().time.increments as f64;
    let field_nodes = match march.femur() {
        FemoralSurface::Mesh(field) => field.nodes() as f64,
        _ => 0.0,
    };
    let law = &march.test().contact;
    let bytes = Limits::BYTES_OF_INSERT_NODE * march.insert().mesh().nodes.len() as f64
        + BYTES_A_TOUCH * histories * touches
        + Limits::BYTES_OF_FIELD_NODE * field_nodes
        + law.memory_bytes(march.insert(), nodes_near);
    PROGRAM_MB + 1e-6 * bytes
}

/// Mean of the axial force over a cycle, N; none where the femur is not pressed by a waveform.
pub(crate) fn mean_load_n(march: &March) -> f64 {
    let Drive::Loaded(load) = &march.test().machine().joint(IS).drive else {
        return 0.0;
    };
    let looked_at = (0..LOOKED_AT).map(|part| part as f64 / LOOKED_AT as f64);
    let sum: f64 = looked_at.map(|phase| load.at(phase).0.abs()).sum();
    sum / LOOKED_AT as f64
}

/// Refuses a march that would need more memory than its case allows.
///
/// # Errors
/// [`RunError::Memory`].
pub(super) fn check_memory(case: &Case, march: &March) -> Result<(), RunError> {
    let allowed_gb = case.limits.memory_gb;
    let whole_surface = march.insert().surface_nodes().len() as f64;
    // Most cases fit even if all of the surface touched, and need no contact solved to know that.
    if 1e-3 * memory_mb_touching(case, march, whole_surface, whole_surface) <= allowed_gb {
        return Ok(());
    }
    let needed_gb = 1e-3 * memory_mb(case, march, &AtRest::of(march));
    if needed_gb <= allowed_gb {
        return Ok(());
    }
    Err(RunError::memory(case, needed_gb))
}
