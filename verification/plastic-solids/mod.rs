//! Thick cylinder and sphere beyond yield.

use condyle_fem::{Elastic, ElasticSolid, Hardening, Vec3};

use crate::{
    Case, Row,
    initial_stress::{InitialStress, Points},
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
    let hardening = Hardening::perfectly_plastic(YIELD_MPA).expect("a yield stress");
    let whole = InitialStress::new(solid, hardening);
    let mesh = whole.solid.mesh();
    let press = |part: f64, state: &[Points]| {
        let scaled = forces
            .iter()
            .map(|&(node, f)| (node, f * (part * pressure_mpa)));
        let solved = whole.solve(&scaled.collect::<Vec<_>>(), state);
        solved.expect("a load below the limit")
    };
    let (mut displacements, mut points) = press(0.0, &whole.unloaded());
    for increment in 1..=INCREMENTS {
        let part = f64::from(increment) / f64::from(INCREMENTS);
        (displacements, points) = press(part, &points);
    }
    let middle = |hex: usize| out(&(mesh.corners(hex).iter().sum::<Vec3>() / 8.0)).norm();
    let has_yielded = |hex: &usize| accumulated(&points[*hex]) > 0.0;
    let yielded = (0..mesh.hexes.len()).filter(has_yielded).map(middle);
    let plastic_mm = yielded.fold(0.0, f64::max);
    let (_, unloaded) = press(0.0, &points);
    let changes =
        (0..mesh.hexes.len()).map(|hex| accumulated(&unloaded[hex]) - accumulated(&points[hex]));
    Solved {
        exact_mm: 0.0,
        found_mm: radial_mm(mesh, &displacements, OUTER_MM, &out),
        plastic_mm,
        unloaded_change: changes.fold(0.0, f64::max),
    }
}

/// Largest accumulated plastic strain in an element.
fn accumulated(points: &Points) -> f64 {
    let points = points.iter();
    points.map(|point| point.accumulated).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::round_solids::grid;

    /// A block of distorted elements between planes of symmetry, 4 mm high, so that stress can be uniform.
    fn block(hardening: Hardening) -> InitialStress {
        let size = [3.0, 4.0, 3.0];
        let mesh = grid([3, 4, 3], |part| {
            let place = [0, 1, 2].map(|k| part[k] * size[k]);
            let number = place[0] + 4.0 * (place[1] + 5.0 * place[2]);
            Vec3::from_fn(|k, _| {
                let is_inside = place[k] > 0.0 && place[k] < size[k];
                let by = 0.25 * (7.0 * number + 3.0 * k as f64).sin();
                place[k] + if is_inside { by } else { 0.0 }
            })
        });
        InitialStress::new(symmetric(&mesh, elastic(0.45), false), hardening)
    }

    fn pull(block: &InitialStress, stress_mpa: f64) -> Vec<(u32, Vec3)> {
        let mesh = block.solid.mesh();
        let mut quads = mesh.boundary_quads();
        quads.retain(|quad| mesh.positions(quad).all(|place| place.y == 4.0));
        mesh.traction_forces(&quads, |_, normal| normal * stress_mpa)
    }

    #[test]
    fn verify_uniaxial_cycle_with_bauschinger_effect() {
        // 14 MPa at yield, then 300 MPa of isotropic and 60 MPa of kinematic modulus.
        let curve = vec![(0.0, 14.0), (0.02, 20.0), (0.1, 28.0)];
        let block = block(Hardening::new(curve, 60.0).unwrap());
        let mut nodes = block.solid.mesh().nodes.iter();
        let top = nodes.position(|place| place.y == 4.0).unwrap();
        let loaded = |stress_mpa: f64, before: &[Points]| {
            let (displacements, points) = block.solve(&pull(&block, stress_mpa), before).unwrap();
            (displacements[top].y / 4.0, points)
        };
        let (strain, up) = loaded(18.0, &block.unloaded());
        let forth = 4.0 / 360.0;
        assert!((strain - (18.0 / MODULUS_MPA + forth)).abs() < 1e-9);
        let (strain, rest) = loaded(0.0, &up);
        assert!((strain - forth).abs() < 1e-9);
        // Backwards it yields at -(14 + 300 forth - 60 forth), before the 18 MPa that it bore forwards.
        let first_yield = 14.0 + 240.0 * forth;
        assert!(loaded(-first_yield + 0.01, &rest).1 == rest);
        let (strain, down) = loaded(-18.0, &rest);
        let back = (18.0 - first_yield) / 360.0;
        assert!((strain - (forth - back - 18.0 / MODULUS_MPA)).abs() < 1e-9);
        assert!((down[7][3].accumulated - forth - back).abs() < 1e-9);
    }

    #[test]
    fn a_load_that_the_material_cannot_carry_has_no_balance() {
        let block = block(Hardening::perfectly_plastic(14.0).unwrap());
        assert!(
            block
                .solve(&pull(&block, 13.9), &block.unloaded())
                .is_some()
        );
        assert!(
            block
                .solve(&pull(&block, 14.5), &block.unloaded())
                .is_none()
        );
    }

    #[test]
    fn verify_plastic_solids() {
        CASE.assert_holds();
    }
}
