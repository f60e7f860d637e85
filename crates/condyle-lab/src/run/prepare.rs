//! Builds a case and starts its march.

use std::path::Path;

use condyle::{
    evolve::{March, WearTest},
    geometry::Counterface,
    machine::Drive,
};
use condyle_case::{
    cache::Cache,
    case::{BuildError, BuildWarning, Built, Case, Limits, SharedBodies},
    config::DataFile,
};

use crate::{at_rest::AtRest, run::error::RunError};

/// Returns the bodies of a case with the femur settled on the insert, before any cycle.
///
/// # Errors
/// The errors of a run that cannot start.
pub fn settled(case: &Case, threads: usize, cache: &Cache) -> Result<March, RunError> {
    let built = build(case, threads, cache)?;
    start(case, built.test, &built.warnings)
}

pub(crate) fn build(case: &Case, threads: usize, cache: &Cache) -> Result<Built, RunError> {
    build_sharing(case, threads, cache, &SharedBodies::default())
}

/// Builds the bodies of a case, which may share some of them with other cases.
pub(crate) fn build_sharing(
    case: &Case,
    threads: usize,
    cache: &Cache,
    bodies: &SharedBodies,
) -> Result<Built, RunError> {
    case.build_sharing(threads, cache, bodies)
        .map_err(|source| RunError::of_build(case, &source))
}

/// Settles the femur on the insert; rejects a march that needs more memory than its case allows, and one whose settled
/// femur presses on a hole.
pub(crate) fn start(
    case: &Case,
    test: WearTest,
    warnings: &[BuildWarning],
) -> Result<March, RunError> {
    let march = March::start(test).map_err(|source| RunError::Placement {
        shown: case.placement_at_its_key(&source, warnings),
        source,
    })?;
    let allowed_gb = case.limits.memory_gb;
    let whole_surface = march.insert().surface_nodes().len() as f64;
    // Most cases fit even with the whole surface in contact, which is known without solving a contact.
    if 1e-3 * memory_mb_touching(case, &march, whole_surface, whole_surface) > allowed_gb {
        let needed_gb = 1e-3 * memory_mb(case, &march, &AtRest::of(&march));
        if needed_gb > allowed_gb {
            return Err(RunError::Case(case.memory_at_its_key(format!(
                "a run needs about {needed_gb:.1} GB of memory, and [limits] memory_gb allows {allowed_gb} GB; use a larger \
                 edge_mm, fewer layers or fewer increments, or allow more"
            ))));
        }
    }
    // The contact at rest is solved only for a mesh with holes.
    if warnings.iter().any(BuildWarning::is_bridge) {
        let at_rest = AtRest::of(&march);
        let touched = at_rest.touched.iter().map(|touched| touched.node as usize);
        check_holes(case, &march, warnings, touched, "as it settles")?;
    }
    Ok(march)
}

/// Rejects a march in which the femur has pressed on a hole so far.
///
/// # Errors
/// [`BuildError::pressed_hole`].
pub(crate) fn check_so_far(
    case: &Case,
    march: &March,
    warnings: &[BuildWarning],
) -> Result<(), RunError> {
    if !warnings.iter().any(BuildWarning::is_bridge) {
        return Ok(());
    }
    let pressures = &march.state().first_pressure_mpa;
    let depths = &march.fields().wear_depth_mm;
    let nodes = 0..pressures.len().min(depths.len());
    let pressed = nodes.filter(|&node| pressures[node] > 0.0 || depths[node] > 0.0);
    check_holes(case, march, warnings, pressed, "on its way")
}

fn check_holes(
    case: &Case,
    march: &March,
    warnings: &[BuildWarning],
    mut pressed: impl Iterator<Item = usize>,
    when: &str,
) -> Result<(), RunError> {
    let places = march.surface().positions;
    let hole_at = |node: usize| {
        let place = [places[node].x, places[node].z];
        warnings.iter().find_map(|warning| warning.hole_at(place))
    };
    let Some(hole) = pressed.find_map(hole_at) else {
        return Ok(());
    };
    let file = case.insert.file().map(DataFile::path);
    let source = BuildError::pressed_hole(file.unwrap_or(Path::new("")), hole, when);
    Err(RunError::of_build(case, &source))
}

/// Memory of the program without a case, MB.
const PROGRAM_MB: f64 = 6.0;
/// Bytes per node in contact and increment: the histories of a cycle and of the previous one.
const BYTES_A_TOUCH: f64 = 230.0;
/// The estimate of the error keeps histories of twice the increments in addition.
const WITH_ESTIMATE: f64 = 2.1;
/// Ratio of the nodes that come near the femur during a test to those near it at rest; approximate.
const EVER_NEAR: f64 = 4.0;
/// Samples of the load in a cycle.
const LOOKED_AT: usize = 50;

/// Estimates the peak memory of a march of `case`, MB.
pub(crate) fn memory_mb(case: &Case, march: &March, at_rest: &AtRest) -> f64 {
    // The area of a contact on a foundation is proportional to the root of its load.
    let larger = (mean_load_n(march) / at_rest.axial_force_n).max(1.0).sqrt();
    let most = march.insert().surface_nodes().len() as f64;
    // The number of nodes in contact cannot exceed the number of nodes.
    let touched = (at_rest.touched.len() as f64 * larger).min(most);
    memory_mb_touching(case, march, touched, EVER_NEAR * at_rest.nodes_near as f64)
}

/// Estimates the peak memory from the number of nodes in contact at an increment and the number of nodes that ever
/// come near the femur.
fn memory_mb_touching(case: &Case, march: &March, nodes_touched: f64, nodes_near: f64) -> f64 {
    let histories = if case.accuracy.estimate {
        WITH_ESTIMATE
    } else {
        1.0
    };
    let touches = nodes_touched * march.test().time.increments as f64;
    let field_nodes = match march.counterface() {
        Counterface::Mesh(field) => field.nodes() as f64,
        _ => 0.0,
    };
    let law = &march.test().contact;
    // The sum of the large arrays; everything else is within the constant part.
    let bytes = Limits::BYTES_OF_INSERT_NODE * march.insert().mesh().nodes.len() as f64
        + BYTES_A_TOUCH * histories * touches
        + Limits::BYTES_OF_FIELD_NODE * field_nodes
        + law.memory_bytes(march.insert(), nodes_near);
    PROGRAM_MB + 1e-6 * bytes
}

/// Returns the mean of the axial force over a cycle, N; 0 without a waveform of axial force.
pub(crate) fn mean_load_n(march: &March) -> f64 {
    let machine = march.test().machine();
    let pressing = machine
        .pressing_joint()
        .map(|index| &machine.joint(index).drive);
    let Some(Drive::Loaded(load)) = pressing else {
        return 0.0;
    };
    let looked_at = (0..LOOKED_AT).map(|part| part as f64 / LOOKED_AT as f64);
    let sum: f64 = looked_at.map(|phase| load.at(phase).0.abs()).sum();
    sum / LOOKED_AT as f64
}
