//! Triangles of the same three corners.

use std::collections::HashSet;

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Keeps one triangle of each three corners; gives where the others were.
pub(super) fn make_single(mesh: &mut TriangleMesh) -> Vec<Vec3> {
    let mut seen = HashSet::with_capacity(mesh.triangles.len());
    let mut places = Vec::new();
    let vertices = &mesh.vertices;
    mesh.triangles.retain(|triangle| {
        let mut sorted = *triangle;
        sorted.sort_unstable();
        let is_first = seen.insert(sorted);
        if !is_first {
            places.push(triangle.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0);
        }
        is_first
    });
    places
}
