//! The flat facets of a mesh, and their distance from the curved surface that they sample.

use super::{
    normals::{creases, sides_across},
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
    ///
    /// A facet of height h that meets its neighbours at an angle a is a h / 8 from a cylinder and a h / 4 from a sphere: the mean
    /// counts. Of two facets the lower height counts, so that a flat surface next to a fillet is flat.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mesh = without_flat_vertices(mesh);
        let (planes, across) = (facet_normals(&mesh), sides_across(&mesh));
        let is_crease = creases(&mesh, &planes, &across);
        let count = mesh.triangles.len();
        let heights: Vec<f64> = (0..count)
            .map(|facet| height(mesh.corners(facet)))
            .collect();
        let chord = |facet: usize| {
            // Creases and slivers are no part of a smooth surface.
            let sides = across[facet].iter().zip(is_crease[facet]);
            let smooth = sides.filter_map(|(other, is_crease)| other.filter(|_| !is_crease));
            let chord = |(other, _): (usize, usize)| {
                let angle = planes[facet].cross(&planes[other]).norm();
                angle * heights[facet].min(heights[other]) / 6.0
            };
            smooth.map(chord).fold(0.0, f64::max)
        };
        Self {
            chord_mm: (0..count).map(chord).collect(),
            mesh,
        }
    }

    /// Returns the distance of the curved surface from a facet at barycentric coordinates on it, mm.
    pub fn chord_mm(&self, facet: usize, [a, b, c]: [f64; 3]) -> f64 {
        // On a quadratic surface it is 4 times the sum of these products over each side's distance.
        self.chord_mm[facet] * (4.0 * (a * b + b * c + c * a)).min(1.0)
    }
}
