//! Whether a body is as large as a knee's: what is laid over it takes memory by its size.

use std::path::Path;

use condyle::Vec3;
use condyle::geometry::TriangleMesh;

use super::super::mesh_file::LengthUnit;
use super::error::BuildError;
use super::pieces::stray_piece;

/// No part of a knee is shorter, mm ...
const MIN_MM: f64 = 5.0;
/// ... or longer.
const MAX_MM: f64 = 500.0;
/// Another unit is the right one if it makes the body this long, mm: as femoral components and
/// inserts are, so that no two units do.
const USUAL_MM: std::ops::RangeInclusive<f64> = 20.0..=200.0;

/// Refuses triangles that reach farther, or less far, than a part of a knee.
pub(super) fn check_triangles(
    file: &Path,
    mesh: &TriangleMesh,
    unit: LengthUnit,
) -> Result<(), BuildError> {
    check_points(file, &mesh.vertices, unit).map_err(|error| match stray_piece(mesh) {
        Some(piece) if is_possible(piece.body_mm) => BuildError::StrayPiece {
            file: file.to_path_buf(),
            piece,
        },
        _ => error,
    })
}

/// The same of points.
pub(super) fn check_points(
    file: &Path,
    points: &[Vec3],
    unit: LengthUnit,
) -> Result<(), BuildError> {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let (low, high) = points
        .iter()
        .fold(none, |(low, high), point| (low.inf(point), high.sup(point)));
    let size_mm = (high - low).max();
    // Without points there is no size, which others refuse.
    if points.is_empty() || is_possible(size_mm) {
        return Ok(());
    }
    let in_unit = |other: LengthUnit| size_mm / unit.in_mm() * other.in_mm();
    let mut units = LengthUnit::ALL.iter().copied();
    let better = units.find(|&other| USUAL_MM.contains(&in_unit(other)));
    Err(BuildError::Size {
        file: file.to_path_buf(),
        size_mm,
        better: better.map(|unit| (unit, in_unit(unit))),
    })
}

fn is_possible(size_mm: f64) -> bool {
    (MIN_MM..=MAX_MM).contains(&size_mm)
}
