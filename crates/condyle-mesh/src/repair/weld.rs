//! Vertices of open edges that rounding keeps apart, made one.

use std::collections::HashMap;

use super::edges::{EdgeUse, by_edge};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Whether each vertex ends an edge that has one triangle only.
pub(super) fn on_open_edges(mesh: &TriangleMesh, uses: &[EdgeUse]) -> Vec<bool> {
    let mut is_open = vec![false; mesh.vertices.len()];
    for edge in by_edge(uses).filter(|edge| edge.len() == 1) {
        edge[0]
            .ends
            .iter()
            .for_each(|&end| is_open[end as usize] = true);
    }
    is_open
}

/// Makes vertices of open edges one that are no farther apart than `within`; gives where they were.
///
/// Only open edges: where a surface hangs together there is nothing to weld.
pub(super) fn weld(mesh: &mut TriangleMesh, uses: &[EdgeUse], within: f64) -> Vec<Vec3> {
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut stands_for: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut places = Vec::new();
    let is_open = on_open_edges(mesh, uses);
    for vertex in (0..mesh.vertices.len()).filter(|&vertex| is_open[vertex]) {
        let at = mesh.vertices[vertex];
        let cell = [at.x, at.y, at.z].map(|coordinate| (coordinate / within).floor() as i64);
        let near = around(cell).filter_map(|cell| kept.get(&cell)).flatten();
        let is_near = |other: &&u32| (mesh.vertices[**other as usize] - at).norm() <= within;
        if let Some(&other) = near.copied().collect::<Vec<_>>().iter().find(is_near) {
            stands_for[vertex] = other;
            places.push(at);
        } else {
            kept.entry(cell).or_default().push(vertex as u32);
        }
    }
    rename(mesh, &stands_for);
    places
}

fn around([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let steps = (0..27).map(|n: i64| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
    steps.map(move |[i, j, k]| {
        [
            x.saturating_add(i),
            y.saturating_add(j),
            z.saturating_add(k),
        ]
    })
}

/// Lets every triangle name the vertex that stands for its own.
pub(super) fn rename(mesh: &mut TriangleMesh, stands_for: &[u32]) {
    for triangle in &mut mesh.triangles {
        *triangle = triangle.map(|vertex| stands_for[vertex as usize]);
    }
}

/// Drops the vertices that no triangle names.
pub(super) fn drop_unused(mesh: &mut TriangleMesh) {
    let mut new_number = vec![u32::MAX; mesh.vertices.len()];
    for &vertex in mesh.triangles.iter().flatten() {
        new_number[vertex as usize] = 0;
    }
    let mut vertices = Vec::new();
    for (old, number) in new_number.iter_mut().enumerate().filter(|(_, n)| **n == 0) {
        *number = vertices.len() as u32;
        vertices.push(mesh.vertices[old]);
    }
    mesh.vertices = vertices;
    rename(mesh, &new_number);
}
