//! A layer on a rigid base, under waves of pressure from long to short.

use std::f64::consts::PI;

use condyle_fem::{Elastic, ElasticSolid, HexMesh, Vec3};

use crate::{Case, Row, round_solids::grid};

pub(crate) const CASE: Case = Case {
    name: "bonded-layer",
    readme: include_str!("README.md"),
    rows,
};

const MODULUS_MPA: f64 = 463.0;
const THICKNESS_MM: f64 = 8.0;
const ALONG: usize = 24;

/// Thickness over the length of a wave over two pi, and accepted error with five elements through it.
const WAVES: [(f64, f64); 4] = [(0.1, 0.01), (0.5, 0.01), (1.0, 0.01), (2.5, 0.02)];

fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for v in [0.3, 0.46, 0.49] {
        for (c, tolerance) in WAVES {
            rows.push(row(v, c, 5, tolerance));
        }
    }
    rows.push(row(0.46, 0.5, 2, 0.03));
    rows.push(row(0.46, 0.5, 1, 0.12));
    rows
}

fn row(v: f64, c: f64, layers: usize, tolerance: f64) -> Row {
    let what = format!("indentation, v = {v}, k h = {c}, elements through the thickness: {layers}");
    Row::relative(
        what,
        "mm",
        exact_mm(v, c),
        indentation_mm(v, c, layers),
        tolerance,
    )
}

fn exact_mm(v: f64, c: f64) -> f64 {
    let shear = MODULUS_MPA / (2.0 * (1.0 + v));
    let above = (3.0 - 4.0 * v) * c.sinh() * c.cosh() - c;
    let below = (3.0 - 4.0 * v) * c.cosh().powi(2) + (1.0 - 2.0 * v).powi(2) + c * c;
    (1.0 - v) * THICKNESS_MM / (shear * c) * above / below
}

/// Amplitude of the surface's wave: its part along the wave of pressure.
fn indentation_mm(v: f64, c: f64, layers: usize) -> f64 {
    let wave_number = c / THICKNESS_MM;
    let mesh = half_wave(PI / wave_number, layers);
    let elastic = Elastic::new(MODULUS_MPA, v).expect("possible constants");
    let is_end = |p: &Vec3| p.x.abs() < 1e-9 || (p.x - PI / wave_number).abs() < 1e-9;
    let nodes = (0u32..).zip(&mesh.nodes);
    let supports = nodes.map(|(n, p)| (n, [p.y == 0.0 || is_end(p), p.y == 0.0, true]));
    let solid = ElasticSolid::with_supports(&mesh, elastic, supports).expect("a held layer");
    let mut top = mesh.boundary_quads();
    top.retain(|quad| mesh.positions(quad).all(|p| p.y == THICKNESS_MM));
    let forces = mesh.traction_forces(&top, |place, normal| {
        -normal * (wave_number * place.x).cos()
    });
    let displacements = solid.displacements(&forces);
    let surface = mesh.nodes.iter().zip(&displacements);
    let waves = surface
        .filter(|(p, _)| p.y == THICKNESS_MM && p.z == 0.0)
        .map(|(p, u)| {
            let share = if is_end(p) { 0.5 } else { 1.0 };
            -share * u.y * (wave_number * p.x).cos()
        });
    2.0 * waves.sum::<f64>() / ALONG as f64
}

fn half_wave(length_mm: f64, layers: usize) -> HexMesh {
    grid([ALONG, layers, 1], |[x, y, z]| {
        Vec3::new(length_mm * x, THICKNESS_MM * y, z)
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_bonded_layer() {
        super::CASE.assert_holds();
    }
}
