//! Blocks of the tests of the deformable insert, the largest so large that a ball in its middle does not feel where it ends.

use condyle::{
    Vec3,
    geometry::{Insert, Meshing, flat_insert},
};

/// How many elements from the middle have the smallest edge.
const EVEN_ELEMENTS: usize = 7;
/// How much larger than the one before each of the others is.
const GROWTH: f64 = 1.8;

/// A block with `elements` elements of `edge_mm` from its middle to each side and to its base.
pub fn half_space(edge_mm: f64, elements: usize) -> Insert {
    let half_mm = elements as f64 * edge_mm;
    let meshing = Meshing {
        edge_mm,
        layers: elements,
    };
    let grid = flat_insert((2.0 * half_mm, 2.0 * half_mm), half_mm, meshing).unwrap();
    moved(&grid, |node| node.map(|mm| grown(mm, edge_mm)))
}

/// A flat insert whose nodes were moved, those of the surface along it.
pub fn moved(grid: &Insert, to: impl Fn(Vec3) -> Vec3) -> Insert {
    let mut mesh = grid.mesh().clone();
    for node in &mut mesh.nodes {
        *node = to(*node);
    }
    let bottom_mm = mesh.nodes.iter().map(|node| node.y).fold(0.0, f64::min);
    let at = |height_mm: f64| {
        let mut quads = mesh.boundary_quads();
        quads.retain(|quad| mesh.positions(quad).all(|node| node.y == height_mm));
        quads
    };
    Insert::new(mesh.clone(), &at(0.0), &at(bottom_mm)).unwrap()
}

/// How far a plane of nodes lies from the middle, from where it lay in a grid of even edges.
pub fn grown(from_middle_mm: f64, edge_mm: f64) -> f64 {
    grown_beyond(EVEN_ELEMENTS, GROWTH, from_middle_mm, edge_mm)
}

/// The same with so many even elements, and so much growth beyond.
pub fn grown_beyond(even: usize, growth: f64, from_middle_mm: f64, edge_mm: f64) -> f64 {
    let number = (from_middle_mm.abs() / edge_mm).round();
    let beyond = (number - even as f64).max(0.0);
    let grown = growth * (growth.powf(beyond) - 1.0) / (growth - 1.0);
    (number - beyond + grown) * edge_mm * from_middle_mm.signum()
}
