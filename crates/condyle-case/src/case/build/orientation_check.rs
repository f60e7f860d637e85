//! Checks of orientation, unit, side and origin of a body by its shape.

use condyle::anatomy::{Orientation, Sureness, flange_lead_mm};
use condyle::geometry::{self, TriangleMesh};
use condyle::{Mat3, Vec3};
use condyle_fem::HexMesh;

use super::super::frame::{LengthUnit, Side};
use super::super::insert::{InsertOrigin, InsertPlacement};
use super::error::{Body, BuildError, BuildWarning, MeshFault, MeshRemark, WrongAxes};
use super::meshes::Placing;
use super::rigid_motion::middle_of_points;
use crate::config::DataFile;

/// Longest extent of a femoral component or an insert of a whole knee, mm: from the smallest sizes on
/// the market, rounded down, to the largest, rounded up.
const WHOLE_KNEE_MM: std::ops::RangeInclusive<f64> = 40.0..=120.0;

/// Checks orientation and unit of a body by its shape: a certain mistake is an error, a likely one a warning. Returns true if
/// the shape confirms the orientation.
pub(super) fn check_orientation(
    body: Body,
    file: &DataFile,
    mesh: &TriangleMesh,
    placing: &Placing,
    warnings: &mut Vec<BuildWarning>,
) -> Result<bool, BuildError> {
    let Some(recognition) = body.recognise(mesh) else {
        return Ok(false);
    };
    check_unit(body, file, mesh, placing.unit, warnings)?;
    let Some(sureness) = recognition.against(&Orientation::ISB) else {
        return Ok(true);
    };
    let turn = recognition.nearest().rotation();
    let wrong = WrongAxes {
        body,
        how: lies(&turn),
        better: placing.axes_turned(&turn),
    };
    if sureness == Sureness::Certain {
        return Err(BuildError::mesh(
            file.path(),
            MeshFault::WrongAxes { wrong },
        ));
    }
    warnings.push(BuildWarning::mesh(file, MeshRemark::WrongAxes { wrong }));
    Ok(false)
}

/// Warns of a femur, in the frame of a right knee, with the shape of the other knee's femur.
pub(super) fn check_side(
    file: &DataFile,
    mesh: &TriangleMesh,
    side: Side,
    warnings: &mut Vec<BuildWarning>,
) {
    let lead_mm = -flange_lead_mm(mesh).unwrap_or(0.0);
    if lead_mm > 0.0 {
        let remark = MeshRemark::OtherSide { side, lead_mm };
        warnings.push(BuildWarning::mesh(file, remark));
    }
}

pub(super) fn check_orientation_of_hexahedra(
    file: &DataFile,
    mesh: &HexMesh,
    placing: &Placing,
    warnings: &mut Vec<BuildWarning>,
) -> Result<bool, BuildError> {
    let boundary = TriangleMesh::of_quads(mesh.nodes.clone(), mesh.boundary_quads());
    check_orientation(Body::Insert, file, &boundary, placing, warnings)
}

/// Checks the size of a whole knee's body; a wrong size is certain if another unit corrects it.
fn check_unit(
    body: Body,
    file: &DataFile,
    mesh: &TriangleMesh,
    unit: LengthUnit,
    warnings: &mut Vec<BuildWarning>,
) -> Result<(), BuildError> {
    let size_mm = longest_mm(mesh);
    if WHOLE_KNEE_MM.contains(&size_mm) {
        return Ok(());
    }
    if let Some(better) = usual_unit(size_mm / unit.in_mm()) {
        let fault = MeshFault::WrongUnit {
            body,
            size_mm,
            better,
        };
        return Err(BuildError::mesh(file.path(), fault));
    }
    let remark = MeshRemark::UnusualSize { body, size_mm };
    warnings.push(BuildWarning::mesh(file, remark));
    Ok(())
}

/// Returns the unit in which a body of length `size` is as long as a knee's, and that length, mm.
pub(crate) fn usual_unit(size: f64) -> Option<(LengthUnit, f64)> {
    let in_mm = |unit: LengthUnit| (unit, size * unit.in_mm());
    let is_usual = |(_, size_mm): &(LengthUnit, f64)| WHOLE_KNEE_MM.contains(size_mm);
    LengthUnit::ALL.iter().copied().map(in_mm).find(is_usual)
}

pub(crate) fn longest_mm(mesh: &TriangleMesh) -> f64 {
    let (low, high) = mesh.bounds();
    (high - low).max()
}

/// Describes the orientation of a body that `turn` corrects.
fn lies(turn: &Mat3) -> &'static str {
    let up = turn * Vec3::y();
    let front = turn * Vec3::x();
    if up.y < -0.5 {
        "upside down"
    } else if up.y < 0.5 {
        "on its side"
    } else if front.x < -0.5 {
        "back to front"
    } else {
        "turned by a quarter about the vertical"
    }
}

/// Largest distance of the middle between the dishes to a side of the origin, mm: each mm moves 2 % of the load to
/// one of them ...
pub(in crate::case) const MAX_ACROSS_MM: f64 = 2.5;
/// ... and to the front or back, mm: dishes are lowest behind the middle of an insert, and the lowest place of flat
/// ones is uncertain.
const MAX_ALONG_MM: f64 = 10.0;

/// Returns a warning if the dishes lie off the origin of their file, whatever the placement.
pub(super) fn off_centre(
    file: &DataFile,
    placement: &InsertPlacement,
    insert: &geometry::Insert,
) -> Option<BuildWarning> {
    let rotation = placement.rotation();
    let nodes = insert.surface().positions;
    let unturned: Vec<Vec3> = nodes
        .iter()
        .map(|node| rotation.transpose() * node)
        .collect();
    let middle = rotation * middle_of_points(&unturned);
    let is_of_file = placement.origin == InsertOrigin::File;
    let is_off = middle.z.abs() > MAX_ACROSS_MM || middle.x.abs() > MAX_ALONG_MM;
    let remark = MeshRemark::OffCentre {
        anterior_mm: middle.x,
        lateral_mm: middle.z,
        most_mm: (MAX_ALONG_MM, MAX_ACROSS_MM),
    };
    (is_of_file && is_off).then(|| BuildWarning::mesh(file, remark))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_a_body_lies_is_said_in_words() {
        let of = |x, y, z| lies(&Mat3::from_diagonal(&Vec3::new(x, y, z)));
        assert_eq!(of(1.0, -1.0, -1.0), "upside down");
        assert_eq!(of(-1.0, 1.0, -1.0), "back to front");
        let quarter = quarter_turn;
        assert_eq!(lies(&quarter(Vec3::x())), "on its side");
        assert_eq!(
            lies(&quarter(Vec3::y())),
            "turned by a quarter about the vertical"
        );
    }

    fn quarter_turn(axis: Vec3) -> Mat3 {
        let cross = axis.cross_matrix();
        Mat3::identity() + cross + cross * cross
    }

    #[test]
    fn units_of_a_knee_are_told_apart() {
        for (size, unit) in [(0.0795, "m"), (7.95, "cm"), (79.5, "mm"), (3.13, "in")] {
            assert_eq!(usual_unit(size).unwrap().0.word(), unit);
        }
        assert_eq!(usual_unit(0.5), None);
    }
}
