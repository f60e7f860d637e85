//! No femur may press where the surface of an insert is made up, over a hole or a post.

use std::path::Path;

use condyle::evolve::March;
use condyle_io::{
    case::{BuildError, BuildWarning, Case},
    config::DataFile,
};

use super::error::RunError;
use crate::at_rest::AtRest;

/// Refuses a march whose settled femur presses at a hole.
///
/// # Errors
/// [`BuildError::PressedHole`].
pub(super) fn check_at_rest(
    case: &Case,
    march: &March,
    warnings: &[BuildWarning],
) -> Result<(), RunError> {
    if !warnings.iter().any(is_bridge) {
        return Ok(());
    }
    let at_rest = AtRest::of(march);
    let touched = at_rest.touched.iter().map(|touched| touched.node as usize);
    check(case, march, warnings, touched, "as it settles")
}

/// Refuses a march in which the femur has pressed at a hole so far.
///
/// # Errors
/// [`BuildError::PressedHole`].
pub(super) fn check_so_far(
    case: &Case,
    march: &March,
    warnings: &[BuildWarning],
) -> Result<(), RunError> {
    if !warnings.iter().any(is_bridge) {
        return Ok(());
    }
    let pressures = &march.state().first_pressure_mpa;
    let depths = &march.fields().wear_depth_mm;
    let pressed = pressures.iter().zip(depths).enumerate();
    let pressed = pressed.filter(|(_, (pressure, depth))| **pressure > 0.0 || **depth > 0.0);
    let pressed = pressed.map(|(node, _)| node);
    check(case, march, warnings, pressed, "on its way")
}

fn is_bridge(warning: &BuildWarning) -> bool {
    matches!(warning, BuildWarning::Bridged { .. })
}

fn check(
    case: &Case,
    march: &March,
    warnings: &[BuildWarning],
    mut pressed: impl Iterator<Item = usize>,
    when: &'static str,
) -> Result<(), RunError> {
    let places = march.insert().surface().positions;
    let hole_at = |node: usize| {
        let place = [places[node].x, places[node].z];
        warnings.iter().find_map(|warning| warning.hole_at(place))
    };
    let Some(hole) = pressed.find_map(hole_at) else {
        return Ok(());
    };
    let file = case.insert.file().map(DataFile::path);
    let source = BuildError::PressedHole {
        file: file.map(Path::to_path_buf).unwrap_or_default(),
        hole: hole.clone(),
        when,
    };
    Err(RunError::of_build(case, source))
}
