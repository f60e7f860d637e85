//! The flat facets of a mesh, and their distance from the curved surface that they sample.

use super::{
    normals::{chords_mm, creases, sides_across},
    samples::{facet_normals, height, without_flat_vertices},
};
use crate::triangle_mesh::TriangleMesh;

/// The flat facets of a mesh, each of which may be divided into several triangles there.
pub(crate) struct Facets {
    /// A triangle for each facet.
    pub mesh: TriangleMesh,
    /// Largest distance of each from the curved surface, mm.
    chord_mm: Vec<f64>,
}

impl Facets {
    /// Finds the facets of `mesh`.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mesh = without_flat_vertices(mesh);
        let (planes, across) = (facet_normals(&mesh), sides_across(&mesh));
        let is_crease = creases(&mesh, &planes, &across);
        let heights_mm: Vec<f64> = (0..mesh.triangles.len())
            .map(|facet| height(mesh.corners(facet)))
            .collect();
        Self {
            chord_mm: chords_mm(&planes, &across, &is_crease, |(facet, _)| heights_mm[facet]),
            mesh,
        }
    }

    /// Returns the distance of the curved surface from a facet at barycentric coordinates on it, mm.
    pub fn chord_mm(&self, facet: usize, [a, b, c]: [f64; 3]) -> f64 {
        // On a quadratic surface it is 4 times the sum of these products over each side's distance.
        self.chord_mm[facet] * (4.0 * (a * b + b * c + c * a)).min(1.0)
    }
}
