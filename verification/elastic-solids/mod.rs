//! Thick cylinder and sphere, and Cook's membrane.

use condyle_fem::{Elastic, ElasticSolid, Vec3};

use crate::{
    Case, Row,
    round_solids::{
        INNER_MM, OUTER_MM, across, cylinder, grid, inner_pressure, radial_mm, sphere, symmetric,
    },
};

pub(crate) const CASE: Case = Case {
    name: "elastic-solids",
    readme: include_str!("README.md"),
    rows,
};

const MODULUS_MPA: f64 = 463.0;

fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for v in [0.3, 0.46, 0.49] {
        rows.push(cylinder_row(v));
        rows.push(sphere_row(v));
    }
    for (elements, tolerance) in [(4, 0.05), (8, 0.02), (16, 0.01)] {
        let what = format!("end of Cook's membrane, {elements} elements a side");
        rows.push(Row::relative(
            what,
            "mm",
            23.96,
            cook_mm(elements),
            tolerance,
        ));
    }
    rows
}

fn elastic(v: f64) -> Elastic {
    Elastic::new(MODULUS_MPA, v).expect("possible constants")
}

/// A value by as many elements as it is given: 4, and 8, whose error is told.
fn refined(what: String, exact: f64, tolerance: f64, value: impl Fn(usize) -> f64) -> Row {
    let [coarse, fine] = [4, 8].map(value);
    let order = ((coarse - exact) / (fine - exact)).abs().log2();
    Row::relative(what, "mm", exact, fine, tolerance).with_order(2.0, order, 0.3)
}

fn cylinder_row(v: f64) -> Row {
    let (a, b) = (INNER_MM, OUTER_MM);
    let exact =
        (1.0 + v) * a * a / (MODULUS_MPA * (b * b - a * a)) * ((1.0 - 2.0 * v) * a + b * b / a);
    refined(
        format!("widening of a cylinder, v = {v}"),
        exact,
        0.005,
        |elements| {
            let mesh = cylinder(elements);
            let forces = inner_pressure(&mesh, |place| across(place).norm());
            let u = symmetric(&mesh, elastic(v), true).displacements(&forces);
            radial_mm(&mesh, &u, a, across)
        },
    )
}

fn sphere_row(v: f64) -> Row {
    let (a, b) = (INNER_MM, OUTER_MM);
    let exact = a.powi(4) / (MODULUS_MPA * (b.powi(3) - a.powi(3)))
        * ((1.0 - 2.0 * v) + (1.0 + v) * (b / a).powi(3) / 2.0);
    refined(
        format!("widening of a sphere, v = {v}"),
        exact,
        0.012,
        |elements| {
            let mesh = sphere(elements);
            let forces = inner_pressure(&mesh, Vec3::norm);
            let u = symmetric(&mesh, elastic(v), false).displacements(&forces);
            radial_mm(&mesh, &u, a, |place| *place)
        },
    )
}

/// How far the middle of the free end goes up.
fn cook_mm(elements: usize) -> f64 {
    let mesh = grid([elements, elements, 1], |[x, y, z]| {
        let (low, high) = (44.0 * x, 44.0 + 16.0 * x);
        Vec3::new(48.0 * x, low + (high - low) * y, z)
    });
    let nodes = (0u32..).zip(&mesh.nodes);
    // One side of the thickness is a plane of symmetry; the other is free.
    let supports = nodes.map(|(n, p)| (n, [p.x == 0.0, p.x == 0.0, p.z == 0.0]));
    let material = Elastic::new(1.0, 1.0 / 3.0).expect("possible constants");
    let solid = ElasticSolid::with_supports(&mesh, material, supports).expect("a held panel");
    let mut end = mesh.boundary_quads();
    end.retain(|quad| mesh.positions(quad).all(|p| p.x == 48.0));
    let forces = mesh.traction_forces(&end, |_, _| Vec3::new(0.0, 1.0 / 16.0, 0.0));
    let middle = mesh.nodes.iter().position(|p| p.x == 48.0 && p.y == 52.0);
    solid.displacements(&forces)[middle.expect("an even number of elements")].y
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_elastic_solids() {
        super::CASE.assert_holds();
    }
}
