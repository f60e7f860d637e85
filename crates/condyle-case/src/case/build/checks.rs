//! Checks of unit, orientation, side and origin of a body by its shape.

use condyle::anatomy::{Orientation, Sureness, flange_lead_mm};
use condyle::geometry::{self, TriangleMesh};
use condyle::{Mat3, Vec3};

use super::error::{Body, BuildError, BuildWarning, Finding};
use super::placing::{Placing, middle_of_points};
use super::size::{in_better_unit, rounded};
use crate::case::contents::Case;
use crate::case::frame::{Axes, LengthUnit, Side};
use crate::case::insert::{InsertOrigin, InsertPlacement};
use crate::config::DataFile;

/// Longest extent of a femoral component or an insert of a whole knee, mm: from the smallest sizes on
/// the market, rounded down, to the largest, rounded up.
const WHOLE_KNEE_MM: std::ops::RangeInclusive<f64> = 40.0..=120.0;
/// Largest distance of the middle between the dishes to a side of the origin, mm: each mm moves 2 % of the load to
/// one of them ...
pub(in crate::case) const MAX_ACROSS_MM: f64 = 2.5;
/// ... and to the front or back, mm: dishes are lowest behind the middle of an insert, and the lowest place of flat
/// ones is uncertain.
const MAX_ALONG_MM: f64 = 10.0;

impl Case {
    /// Checks orientation and unit of a body by its shape: a certain mistake is an error, a likely one a warning. Returns true if
    /// the shape confirms the orientation.
    pub(super) fn check_orientation(
        &self,
        body: Body,
        file: &DataFile,
        mesh: &TriangleMesh,
        placing: &Placing,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<bool, BuildError> {
        // Femora and inserts of knees are recognised; other joints have bodies of other shapes.
        let recognition = self.tests_knee().then(|| body.recognise(mesh));
        let Some(recognition) = recognition.flatten() else {
            return Ok(false);
        };
        let size_mm = longest_mm(mesh);
        if !WHOLE_KNEE_MM.contains(&size_mm) {
            let is_long = format!(
                "this {body} is {} mm long, and that of a whole knee is 40 mm to 120 mm",
                rounded(size_mm)
            );
            // A wrong size is certain if another unit corrects it.
            if let Some(better) = usual_unit(size_mm / placing.unit.in_mm()) {
                let message = format!("{is_long}; {}", in_better_unit(better));
                let keys = &["length_unit", "file"];
                return Err(BuildError::mesh(file.path(), keys, message));
            }
            let remark = format!("{is_long}; check length_unit");
            warnings.push(BuildWarning::mesh(file, remark));
        }
        let Some(sureness) = recognition.against(&Orientation::ISB) else {
            return Ok(true);
        };
        let turn = recognition.nearest().rotation();
        let signs = match body {
            Body::Femur => {
                "the box open above, the trochlea in front and the notch between the condyles behind"
            }
            Body::Insert => {
                "two dishes above, the flat backside below, the notch or the lower lip behind"
            }
        };
        let lies = lies(&turn);
        let [x, y, z] = Axes::of(&placing.rotation_turned(&turn)).words();
        let advice =
            format!("write axes = [\"{x}\", \"{y}\", \"{z}\"], as its shape indicates ({signs})");
        if sureness == Sureness::Certain {
            let message = format!("this {body} lies {lies}; {advice}");
            return Err(BuildError::mesh(file.path(), &["axes", "file"], message));
        }
        let remark = format!("this {body} is probably oriented {lies}; {advice}");
        warnings.push(BuildWarning::mesh(file, remark).with(Finding::WrongAxes(body)));
        Ok(false)
    }
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
        let (of_case, other) = (side.word(), side.other().word());
        let remark = format!(
            "with side = \"{of_case}\", the medial flange of the trochlea extends {} mm beyond the lateral one, as in a \
             {other} knee; write side = \"{other}\", or check that the axes and the files are of one knee",
            rounded(lead_mm)
        );
        warnings.push(BuildWarning::mesh(file, remark));
    }
}

/// Returns the unit in which a body of length `size` is as long as a knee's, and that length, mm.
pub(in crate::case) fn usual_unit(size: f64) -> Option<(LengthUnit, f64)> {
    let in_mm = |unit: LengthUnit| (unit, size * unit.in_mm());
    let is_usual = |(_, size_mm): &(LengthUnit, f64)| WHOLE_KNEE_MM.contains(size_mm);
    LengthUnit::ALL.iter().copied().map(in_mm).find(is_usual)
}

pub(in crate::case) fn longest_mm(mesh: &TriangleMesh) -> f64 {
    let (low, high) = mesh.bounds();
    (high - low).max()
}

/// Describes the orientation of a body that `turn` corrects.
fn lies(turn: &Mat3) -> &'static str {
    let up = turn * Vec3::y();
    let front = turn * Vec3::x();
    // Orientations are multiples of a quarter turn: any threshold between 0 and 1 separates them.
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
    let is_off = middle.z.abs() > MAX_ACROSS_MM || middle.x.abs() > MAX_ALONG_MM;
    (placement.origin == InsertOrigin::File && is_off).then(|| {
        let front = if middle.x < 0.0 { "posterior" } else { "anterior" };
        let side = if middle.z < 0.0 { "medial" } else { "lateral" };
        let remark = format!(
            "the middle of the dishes is {:.1} mm {front} and {:.1} mm {side} of the origin, where the machine's axes are; \
             up to {MAX_ALONG_MM} mm in front or behind and {MAX_ACROSS_MM} mm to a side are acceptable; write \
             origin = \"centre\" in [insert], or move the file's origin",
            middle.x.abs(),
            middle.z.abs()
        );
        BuildWarning::mesh(file, remark)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orientation_of_a_body_is_described() {
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
    fn the_unit_follows_from_the_size_of_a_knee() {
        for (size, unit) in [(0.0795, "m"), (7.95, "cm"), (79.5, "mm"), (3.13, "in")] {
            assert_eq!(usual_unit(size).unwrap().0.word(), unit);
        }
        assert_eq!(usual_unit(0.5), None);
    }
}
