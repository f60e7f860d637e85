//! A load off the centre line, shared between two condyles.

use condyle::machine::knee::{LATERAL, MEDIAL};

use crate::{
    Case, Row,
    marched::{marched, test_of},
};

pub(crate) const CASE: Case = Case {
    name: "off-centre-load",
    readme: include_str!("README.md"),
    rows,
};

const LOAD_N: f64 = 2000.0;
const HALF_SPACING_MM: f64 = 23.0;

fn rows() -> Vec<Row> {
    let offsets_mm = [0.0, 5.0, 12.0, -5.0];
    offsets_mm.into_iter().flat_map(shared).collect()
}

/// Shares and sum of the load with the axis `medial_mm` medial of the middle.
fn shared(medial_mm: f64) -> [Row; 3] {
    let march = marched(test_of(&case(medial_mm)));
    let (_, last) = march.state().activities[0]
        .first_and_last
        .as_ref()
        .expect("a cycle");
    let row = last.rows.last().expect("an increment");
    let share = |n: f64| 100.0 * n / row.axial_force_n;
    let exact = 50.0 * (HALF_SPACING_MM + medial_mm) / HALF_SPACING_MM;
    let (medial, lateral) = (
        share(row.region_force_n[MEDIAL]),
        share(row.region_force_n[LATERAL]),
    );
    let what = |side: &str| format!("{side} share, axis {medial_mm} mm medial");
    [
        Row::absolute(what("medial"), "%", exact, medial, 0.01),
        Row::absolute(what("lateral"), "%", 100.0 - exact, lateral, 0.01),
        Row::relative(
            format!("axial force, axis {medial_mm} mm medial"),
            "N",
            LOAD_N,
            row.axial_force_n,
            1e-5,
        ),
    ]
}

fn case(medial_mm: f64) -> String {
    format!(
        "\
[femur]
spacing_mm = {spacing:?}
coronal_radius_mm = 24.0
[insert]
shape = \"flat\"
layers = 1
[contact]
friction = 0.0
[machine]
vv_axis_medial_mm = {medial_mm:?}
vv_axis_below_mm = -24.0
[machine.axial_force]
knots_n = [[0, {LOAD_N:?}]]
[machine.freedoms]
ap.drive = \"locked\"
ie.drive = \"locked\"
ml.drive = \"locked\"
flexion.drive = \"locked\"
[march]
cycles = 1
updates = 1
[time]
increments = 20
force_tolerance_n = 1e-6
",
        spacing = 2.0 * HALF_SPACING_MM
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_off_centre_load() {
        super::CASE.assert_holds();
    }
}
