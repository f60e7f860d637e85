//! Which triangles meet in which edge.

use std::collections::BTreeMap;

use crate::triangle_mesh::TriangleMesh;

/// One side of one triangle.
#[derive(Clone, Copy)]
pub(super) struct EdgeUse {
    /// Vertices of the edge, the lower number first.
    pub(super) ends: [u32; 2],
    pub(super) triangle: u32,
    /// The triangle runs from the lower vertex to the higher.
    pub(super) rises: bool,
}

/// All sides of all triangles, those of one edge together.
pub(super) fn edge_uses(mesh: &TriangleMesh) -> Vec<EdgeUse> {
    let mut uses = Vec::with_capacity(3 * mesh.triangles.len());
    for (triangle, &[a, b, c]) in (0..).zip(&mesh.triangles) {
        uses.extend([[a, b], [b, c], [c, a]].map(|[from, to]| EdgeUse {
            ends: [from.min(to), from.max(to)],
            triangle,
            rises: from < to,
        }));
    }
    uses.sort_unstable_by_key(|edge| (edge.ends, edge.triangle));
    uses
}

/// The uses, edge by edge.
pub(super) fn by_edge(uses: &[EdgeUse]) -> impl Iterator<Item = &[EdgeUse]> {
    uses.chunk_by(|one, other| one.ends == other.ends)
}

/// How the triangles of a mesh hang together, without any repair.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EdgeReport {
    /// Edges with one triangle only.
    pub open_edges: usize,
    /// Vertices round each hole or along each rim, in the sense of the triangles.
    pub boundary_loops: Vec<Vec<u32>>,
    /// Edges with three triangles or more.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges whose two triangles are turned against one another.
    pub inconsistent_edges: usize,
}

impl EdgeReport {
    /// Every edge has exactly two triangles.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0 && self.non_manifold_edges.is_empty()
    }
}

/// Reports open, non-manifold and inconsistent edges of a triangle mesh as it is.
pub fn edge_report(mesh: &TriangleMesh) -> EdgeReport {
    let uses = edge_uses(mesh);
    let mut report = EdgeReport::default();
    let mut next = BTreeMap::new();
    for edge in by_edge(&uses) {
        match edge {
            [only] => {
                let [low, high] = only.ends;
                let (from, to) = if only.rises { (low, high) } else { (high, low) };
                next.entry(from).or_insert_with(Vec::new).push(to);
                report.open_edges += 1;
            }
            [one, other] => report.inconsistent_edges += usize::from(one.rises == other.rises),
            several => report.non_manifold_edges.push(several[0].ends),
        }
    }
    report.boundary_loops = loops(next);
    report
}

/// Follows the rim from vertex to vertex until it ends or comes back.
fn loops(mut next: BTreeMap<u32, Vec<u32>>) -> Vec<Vec<u32>> {
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut around = vec![start];
        let mut at = start;
        while let Some(to) = step(&mut next, at).filter(|&to| to != start) {
            around.push(to);
            at = to;
        }
        loops.push(around);
    }
    loops
}

fn step(next: &mut BTreeMap<u32, Vec<u32>>, from: u32) -> Option<u32> {
    let ends = next.get_mut(&from)?;
    let to = ends.pop();
    if ends.is_empty() {
        next.remove(&from);
    }
    to
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::fixtures::unit_block;

    #[test]
    fn a_closed_block_has_nothing_to_report() {
        let report = edge_report(&unit_block());
        assert_eq!(report, EdgeReport::default());
        assert!(report.is_closed());
    }

    #[test]
    fn an_open_block_has_a_loop_round_each_hole() {
        let mut mesh = unit_block();
        mesh.triangles.drain(..4);
        let report = edge_report(&mesh);
        assert_eq!(report.open_edges, 8);
        assert_eq!(report.boundary_loops, [vec![0, 1, 3, 2], vec![4, 6, 7, 5]]);
        assert!(!report.is_closed());
    }

    #[test]
    fn walls_and_turned_triangles_are_counted() {
        let mut mesh = unit_block();
        mesh.triangles[0].swap(0, 1);
        assert_eq!(edge_report(&mesh).inconsistent_edges, 3);
        mesh.triangles.push([0, 4, 3]);
        assert_eq!(edge_report(&mesh).non_manifold_edges, [[0, 3], [0, 4]]);
    }
}
