//! Vertices that lie on an open edge of another triangle: that is split there, so that the two hang together.

use std::{collections::BTreeMap, ops::ControlFlow};

use super::{
    box_tree::BoxTree,
    edges::{EdgeUse, by_edge, edge_uses},
};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// A split edge may leave triangles with another edge to split; more rounds than this help nobody.
const ROUNDS: usize = 4;

/// Distance over the diagonal of the mesh within which vertices are on an edge but for rounding.
const ROUNDING: f64 = 1e-9;

/// Joins to their neighbours triangles that close a loop of edges: they pass over vertices that lie in line.
pub(super) fn join_filled(mesh: &mut TriangleMesh) {
    let (low, high) = mesh.bounds();
    join(mesh, ROUNDING * (high - low).norm());
}

/// Splits triangles at vertices on their open edges, no farther off than `within`; gives where.
pub(super) fn join(mesh: &mut TriangleMesh, within: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    for _ in 0..ROUNDS {
        let on_edges = vertices_on_edges(mesh, &edge_uses(mesh), within);
        if on_edges.is_empty() {
            break;
        }
        for (triangle, ([from, to], between)) in on_edges {
            places.extend(
                between
                    .iter()
                    .map(|&(_, vertex)| mesh.vertices[vertex as usize]),
            );
            split(mesh, triangle as usize, [from, to], &between);
        }
    }
    places
}

/// Vertices with their share of the way along the edge.
type Between = Vec<(f64, u32)>;

/// For each triangle one of its open edges with the vertices of other open edges between its ends.
fn vertices_on_edges(
    mesh: &TriangleMesh,
    uses: &[EdgeUse],
    within: f64,
) -> BTreeMap<u32, ([u32; 2], Between)> {
    let open: Vec<EdgeUse> = by_edge(uses)
        .filter(|edge| edge.len() == 1)
        .map(|edge| edge[0])
        .collect();
    // Triangles that share no edges are no surface with a few joints.
    if open.len() > mesh.triangles.len() {
        return BTreeMap::new();
    }
    let lines = TriangleMesh {
        vertices: mesh.vertices.clone(),
        triangles: open
            .iter()
            .map(|edge| [edge.ends[0], edge.ends[1], edge.ends[1]])
            .collect(),
    };
    let mut found: BTreeMap<u32, ([u32; 2], Between)> = BTreeMap::new();
    BoxTree::with_margin(&lines, within).for_close_pairs(|one, other| {
        for (edge, ends) in [
            (&open[one], open[other].ends),
            (&open[other], open[one].ends),
        ] {
            let triangle = mesh.triangles[edge.triangle as usize];
            let beside = ends.into_iter().filter(|end| !triangle.contains(end));
            for vertex in beside {
                if let Some(share) = share_along(mesh, edge.ends, vertex, within) {
                    let (ends, between) = found
                        .entry(edge.triangle)
                        .or_insert((edge.ends, Vec::new()));
                    if *ends == edge.ends && !between.contains(&(share, vertex)) {
                        between.push((share, vertex));
                    }
                }
            }
        }
        ControlFlow::Continue(())
    });
    for (_, between) in found.values_mut() {
        between.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
    }
    found
}

/// How far along an edge a vertex lies, if it lies on it and at none of its ends.
fn share_along(mesh: &TriangleMesh, ends: [u32; 2], vertex: u32, within: f64) -> Option<f64> {
    let [from, to] = ends.map(|end| mesh.vertices[end as usize]);
    let (way, at) = (to - from, mesh.vertices[vertex as usize] - from);
    let share = at.dot(&way) / way.norm_squared();
    let margin = within / way.norm();
    let is_on = (at - way * share).norm() <= within && share > margin && share < 1.0 - margin;
    is_on.then_some(share)
}

/// Puts vertices into the edge of a triangle, which becomes a fan.
fn split(mesh: &mut TriangleMesh, triangle: usize, [from, to]: [u32; 2], between: &Between) {
    let whole = mesh.triangles[triangle];
    let chain = [from]
        .into_iter()
        .chain(between.iter().map(|&(_, vertex)| vertex))
        .chain([to]);
    let chain: Vec<u32> = chain.collect();
    let mut parts = chain.windows(2).map(|ends| {
        whole.map(|corner| {
            if corner == from {
                ends[0]
            } else if corner == to {
                ends[1]
            } else {
                corner
            }
        })
    });
    if let Some(first) = parts.next() {
        mesh.triangles[triangle] = first;
    }
    mesh.triangles.extend(parts);
}
