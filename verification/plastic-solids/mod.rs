//! Thick cylinder and sphere beyond yield.

use condyle_fem::{
    Elastic, ElasticSolid, Hardening, PlasticSolid, PlasticSolution, PlasticState, Vec3,
};

use crate::{
    Case, Row,
    round_solids::{
        INNER_MM, OUTER_MM, across, cylinder, inner_pressure, radial_mm, sphere, symmetric,
    },
};

pub(crate) const CASE: Case = Case {
    name: "plastic-solids",
    readme: include_str!("README.md"),
    rows,
};

const MODULUS_MPA: f64 = 571.6;
const YIELD_MPA: f64 = 14.0;
/// Radius up to which the wall is plastic.
const PLASTIC_MM: f64 = 15.0;
const ELEMENTS: usize = 12;
const INCREMENTS: u32 = 4;

fn rows() -> Vec<Row> {
    let [sphere, cylinder] = [sphere_solved(), cylinder_solved()];
    let back = &cylinder.unloaded_change;
    vec![
        Row::relative(
            "outside of a sphere",
            "mm",
            sphere.exact_mm,
            sphere.found_mm,
            0.01,
        ),
        Row::relative(
            "outside of a cylinder",
            "mm",
            cylinder.exact_mm,
            cylinder.found_mm,
            0.01,
        ),
        Row::absolute(
            "plastic strain added by unloading, cylinder",
            "",
            0.0,
            *back,
            1e-12,
        ),
        sphere.radius_row("sphere"),
        cylinder.radius_row("cylinder"),
    ]
}

struct Solved {
    exact_mm: f64,
    found_mm: f64,
    /// Largest radius of a Gauss point that has yielded, by its element's middle.
    plastic_mm: f64,
    /// Largest change of accumulated plastic strain as the load is taken off.
    unloaded_change: f64,
}

impl Solved {
    fn radius_row(&self, what: &str) -> Row {
        // Where in an element yielding ends is not known; what is found is the middle of the last.
        let element_mm = (OUTER_MM - INNER_MM) / ELEMENTS as f64;
        let what = format!("plastic radius of a {what}");
        Row::absolute(what, "mm", PLASTIC_MM, self.plastic_mm, 0.6 * element_mm)
    }
}

fn sphere_solved() -> Solved {
    let (a, b, c, v) = (INNER_MM, OUTER_MM, PLASTIC_MM, 0.45);
    let pressure_mpa =
        2.0 * YIELD_MPA * (c / a).ln() + 2.0 / 3.0 * YIELD_MPA * (1.0 - (c / b).powi(3));
    let mesh = sphere(ELEMENTS);
    let solid = symmetric(&mesh, elastic(v), false);
    let forces = inner_pressure(&mesh, Vec3::norm);
    Solved {
        exact_mm: (1.0 - v) * YIELD_MPA * c.powi(3) / (MODULUS_MPA * b * b),
        ..loaded(solid, &forces, pressure_mpa, |place| *place)
    }
}

fn cylinder_solved() -> Solved {
    let (a, b, c, v) = (INNER_MM, OUTER_MM, PLASTIC_MM, 0.49);
    let k = YIELD_MPA / 3f64.sqrt();
    let pressure_mpa = k * (1.0 - (c / b).powi(2) + 2.0 * (c / a).ln());
    let mesh = cylinder(ELEMENTS);
    let solid = symmetric(&mesh, elastic(v), true);
    let forces = inner_pressure(&mesh, |place| across(place).norm());
    Solved {
        exact_mm: 2.0 * (1.0 - v * v) * k * c * c / (MODULUS_MPA * b),
        ..loaded(solid, &forces, pressure_mpa, across)
    }
}

fn elastic(v: f64) -> Elastic {
    Elastic::new(MODULUS_MPA, v).expect("possible constants")
}

/// Loads a solid in increments, and takes the load off.
fn loaded(
    solid: ElasticSolid,
    forces: &[(u32, Vec3)],
    pressure_mpa: f64,
    out: impl Fn(&Vec3) -> Vec3,
) -> Solved {
    let mesh = solid.mesh().clone();
    let hardening = Hardening::perfectly_plastic(YIELD_MPA).expect("a yield stress");
    let solid = PlasticSolid::new(solid, hardening);
    let press = |part: f64, state: &PlasticState| {
        let scaled = forces
            .iter()
            .map(|&(node, f)| (node, f * (part * pressure_mpa)));
        let solved = solid.solve(&scaled.collect::<Vec<_>>(), state);
        solved.expect("a load below the limit")
    };
    let mut solved = press(0.0, &PlasticState::unloaded(mesh.hexes.len()));
    for increment in 1..=INCREMENTS {
        solved = press(f64::from(increment) / f64::from(INCREMENTS), &solved.state);
    }
    let middle = |hex: usize| out(&(mesh.corners(hex).iter().sum::<Vec3>() / 8.0)).norm();
    let has_yielded = |hex: &usize| accumulated(&solved, *hex) > 0.0;
    let yielded = (0..mesh.hexes.len()).filter(has_yielded).map(middle);
    let plastic_mm = yielded.fold(0.0, f64::max);
    let unloaded = press(0.0, &solved.state);
    let changes =
        (0..mesh.hexes.len()).map(|hex| accumulated(&unloaded, hex) - accumulated(&solved, hex));
    Solved {
        exact_mm: 0.0,
        found_mm: radial_mm(&mesh, &solved.displacements, OUTER_MM, &out),
        plastic_mm,
        unloaded_change: changes.fold(0.0, f64::max),
    }
}

/// Largest accumulated plastic strain in an element.
fn accumulated(solved: &PlasticSolution, hex: usize) -> f64 {
    let points = solved.state.elements[hex].iter();
    points.map(|point| point.accumulated).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_plastic_solids() {
        super::CASE.assert_holds();
    }
}
