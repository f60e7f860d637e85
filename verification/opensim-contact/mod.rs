//! The contact of a real implant against OpenSim's.

use std::path::{Path, PathBuf};

use condyle::{
    Mat3, Vec3,
    spatial::{Pose, RelativeMotion},
};

use crate::{
    Case, Row,
    marched::{bodies_of, case_in, started},
    pressed::{Pressed, contact_of, press},
};

pub(crate) const CASE: Case = Case {
    name: "opensim-contact",
    readme: include_str!("README.md"),
    rows,
};

const POSES: &str = include_str!("poses.csv");
/// OpenSim on the meshes as they are, and on meshes whose facets are rounded.
const FACETS: &str = include_str!("facets.csv");
const ROUNDED: &str = include_str!("rounded.csv");

const FEMUR: &str = "../../../shared/data/dm-knee/femoral-component.stl";

/// Stiffness of the foundation in both programs, MPa/mm.
const STIFFNESS: f64 = 268.0;
/// How much fuller the smooth femur may be than one of facets: its edges of about 1 mm on radii of
/// 25 to 40 mm have sagittas of 3 to 5 micrometres.
const SAGITTA_MM: f64 = 0.004;
/// What the rest of the facets and the nodes of 1.05 mm may leave.
const FORCE: f64 = 0.04;
const AREA: f64 = 0.05;

/// Force on the insert and area at one pose.
struct Theirs {
    force_n: Vec3,
    area_mm2: f64,
}

/// No rows without the implant, which is no part of condyle.
fn rows() -> Vec<Row> {
    if !has_data() {
        return Vec::new();
    }
    let ours = ours();
    let rounded = read(ROUNDED);
    let facets = read(FACETS);
    let mut rows = Vec::new();
    for ((place, ours), theirs) in POSES.lines().skip(1).zip(&ours).zip(&rounded) {
        let percent = place.split(',').next().unwrap_or_default();
        let (exact, force) = (theirs.force_n.norm(), ours.force_n.norm());
        rows.push(Row::relative(
            format!("force at {percent} %"),
            "N",
            exact,
            force,
            FORCE,
        ));
        let area = format!("area at {percent} %");
        rows.push(Row::relative(
            area,
            "mm2",
            theirs.area_mm2,
            ours.area_mm2,
            AREA,
        ));
    }
    let approach = ours
        .iter()
        .zip(&facets)
        .map(|(ours, theirs)| approach_mm(ours, theirs));
    let most = approach.fold(0.0, f64::max);
    let what = "largest approach that compensates for OpenSim's facets";
    rows.push(Row::absolute(what, "mm", 0.0, most, SAGITTA_MM));
    rows
}

/// How far the femur would have to come down on facets for the force of the smooth one.
fn approach_mm(ours: &Pressed, theirs: &Theirs) -> f64 {
    (ours.force_n.norm() - theirs.force_n.norm()).abs() / (STIFFNESS * theirs.area_mm2)
}

/// Condyle at the same poses.
fn ours() -> Vec<Pressed> {
    let (march, law) = started(&case_in(include_str!("dm-knee-uniform.toml"), &folder()));
    let surface = march.insert().surface();
    let mut contact = contact_of(&law, bodies_of(&march, &surface));
    let at = |line: &str| press(contact.as_mut(), &at_rest(&numbers(line)));
    POSES.lines().skip(1).map(at).collect()
}

fn has_data() -> bool {
    folder().join(FEMUR).exists()
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("opensim-contact")
}

fn at_rest(row: &[f64]) -> RelativeMotion {
    RelativeMotion::at_rest(Pose::new(
        Mat3::from_row_slice(&row[1..10]),
        Vec3::from_row_slice(&row[10..13]),
    ))
}

/// Rows of OpenSim's answers, after the line that says its version and the header.
fn read(text: &str) -> Vec<Theirs> {
    let theirs = |line: &str| {
        let row = numbers(line);
        Theirs {
            force_n: Vec3::from_row_slice(&row[1..4]),
            area_mm2: row[4],
        }
    };
    text.lines().skip(2).map(theirs).collect()
}

fn numbers(line: &str) -> Vec<f64> {
    let number = |word: &str| word.parse().expect("a number");
    line.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn cross_opensim_contact() {
        let name = "cross_opensim_contact";
        if super::has_data() {
            super::CASE.assert_holds();
        } else {
            eprintln!("skipped: {name}: the implant of subject DM is not there");
        }
    }
}
