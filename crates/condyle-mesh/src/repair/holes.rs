//! Closes loops of open edges with triangles, and joins vertices to the open edges that they lie on.

use std::{collections::BTreeMap, ops::ControlFlow};

use earcut::Earcut;

use super::{
    box_tree::BoxTree,
    defect::{DefectKind, Judge},
    edges::{EdgeUse, Piece, by_edge, edge_report, edge_uses},
};
use crate::{
    Vec3,
    triangle_mesh::{TriangleMesh, bounds},
};

/// Ratio of the diagonal of the longest loop of a piece to the diagonal of the piece, above which the loop is the rim
/// of the piece and not a hole.
const RIM: f64 = 1.0 / 3.0;

/// Judges all holes, and closes those where nothing touches, flat from edge to edge.
pub(super) fn close_holes(mesh: &mut TriangleMesh, pieces: &[Piece], judge: &mut Judge) {
    if pieces.iter().all(|piece| !piece.is_open) {
        return;
    }
    let mut filled = false;
    for around in holes(mesh, pieces) {
        let places: Vec<Vec3> = around.iter().map(|&v| mesh.vertices[v as usize]).collect();
        let middle = places.iter().sum::<Vec3>() / places.len() as f64;
        let matters = judge.judge(mesh, DefectKind::Hole, middle, &places);
        // Twice the area that the loop bounds, along its normal.
        let spans = places.iter().zip(places.iter().cycle().skip(1));
        let area: Vec3 = spans
            .map(|(a, b)| (a - places[0]).cross(&(b - places[0])))
            .sum();
        // The loop runs in the sense of the triangles around it, so that the filling faces the other way.
        if let Some(normal) = area.try_normalize(0.0).filter(|_| !matters) {
            fill(mesh, &[around], &-normal);
            filled = true;
        }
    }
    if filled {
        join_filled(mesh);
    }
}

/// Returns the loops that are not the rim of an open piece.
fn holes(mesh: &TriangleMesh, pieces: &[Piece]) -> Vec<Vec<u32>> {
    let mut piece_of = vec![0; mesh.vertices.len()];
    for (number, piece) in pieces.iter().enumerate() {
        piece
            .vertices(mesh)
            .for_each(|vertex| piece_of[vertex as usize] = number);
    }
    let mut loops = vec![Vec::new(); pieces.len()];
    for around in edge_report(mesh).boundary_loops {
        loops[piece_of[around[0] as usize]].push(around);
    }
    let diagonal = |(low, high): (Vec3, Vec3)| (high - low).norm();
    for (piece, loops) in pieces.iter().zip(&mut loops) {
        let size = |around: &Vec<u32>| {
            let places = around.iter().map(|&vertex| &mesh.vertices[vertex as usize]);
            diagonal(bounds(places))
        };
        let sizes = loops.iter().map(size).enumerate();
        let longest = sizes.max_by(|one, other| one.1.total_cmp(&other.1));
        let whole = diagonal(piece.bounds(mesh));
        if let Some((rim, _)) = longest.filter(|(_, size)| *size > RIM * whole) {
            loops.remove(rim);
        }
    }
    let all = loops.into_iter().flatten();
    all.filter(|around| around.len() > 2).collect()
}

/// Adds the triangles inside the loops, seen in a plane of this normal; loops within others are holes. The triangles
/// face along the normal.
pub(super) fn fill(mesh: &mut TriangleMesh, loops: &[Vec<u32>], normal: &Vec3) {
    // Across the axis that the normal leans to least: their product is never near zero.
    let first = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let axes = [first, normal.cross(&first).normalize()];
    let rings = loops.iter().map(|around| Ring::new(mesh, around, &axes));
    let rings: Vec<Ring> = rings.collect();
    let depth = |ring: &Ring| rings.iter().filter(|other| other.contains(ring)).count();
    let depths: Vec<usize> = rings.iter().map(depth).collect();
    for (outer, depth) in rings.iter().zip(&depths) {
        if depth % 2 == 0 {
            let within = rings
                .iter()
                .zip(&depths)
                .filter(|(_, own)| **own == depth + 1);
            let holes = within
                .map(|(ring, _)| ring)
                .filter(|ring| outer.contains(ring));
            add_polygon(mesh, outer, holes);
        }
    }
}

struct Ring {
    vertices: Vec<u32>,
    places: Vec<[f64; 2]>,
    low: [f64; 2],
    high: [f64; 2],
}

impl Ring {
    fn new(mesh: &TriangleMesh, around: &[u32], axes: &[Vec3; 2]) -> Self {
        let place = |&vertex: &u32| axes.map(|axis| axis.dot(&mesh.vertices[vertex as usize]));
        let places: Vec<[f64; 2]> = around.iter().map(place).collect();
        let end = |pick: fn(f64, f64) -> f64, from: f64| {
            [0, 1].map(|axis| places.iter().map(|at| at[axis]).fold(from, pick))
        };
        Self {
            low: end(f64::min, f64::INFINITY),
            high: end(f64::max, f64::NEG_INFINITY),
            vertices: around.to_vec(),
            places,
        }
    }

    /// Returns whether another loop lies within: by the parity of the edges that a ray from one of its points crosses.
    fn contains(&self, other: &Self) -> bool {
        let [x, y] = other.places[0];
        let is_beyond = |axis: usize, at: f64| at < self.low[axis] || at > self.high[axis];
        if std::ptr::eq(self, other) || is_beyond(0, x) || is_beyond(1, y) {
            return false;
        }
        let edges = self.places.iter().zip(self.places.iter().cycle().skip(1));
        let crossed = edges.filter(|&(&[x1, y1], &[x2, y2])| {
            (y1 > y) != (y2 > y) && x < x1 + (y - y1) / (y2 - y1) * (x2 - x1)
        });
        crossed.count() % 2 == 1
    }
}

fn add_polygon<'r>(mesh: &mut TriangleMesh, outer: &Ring, holes: impl Iterator<Item = &'r Ring>) {
    let mut vertices = outer.vertices.clone();
    let mut places = outer.places.clone();
    let mut starts = Vec::new();
    for hole in holes {
        starts.push(vertices.len() as u32);
        vertices.extend(&hole.vertices);
        places.extend(&hole.places);
    }
    // Ear cutting keeps all vertices of the loops, so that the filling fits their edges.
    let mut corners: Vec<u32> = Vec::new();
    Earcut::new().earcut(places.iter().copied(), &starts, &mut corners);
    for &[a, b, c] in corners.as_chunks().0 {
        let [p, q, r] = [a, b, c].map(|corner| places[corner as usize]);
        let twice_area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let facing = if twice_area > 0.0 {
            [a, b, c]
        } else {
            [a, c, b]
        };
        mesh.triangles
            .push(facing.map(|corner| vertices[corner as usize]));
    }
}

/// A split edge may leave triangles with another edge to split; more rounds than this do not help.
const MAX_ROUNDS: usize = 4;

/// Distance over the diagonal of the mesh within which vertices are on an edge except for rounding.
const ROUNDING: f64 = 1e-9;

/// Joins triangles that close a loop of edges to their neighbours: they pass over vertices that lie in line.
pub(super) fn join_filled(mesh: &mut TriangleMesh) {
    let (low, high) = mesh.bounds();
    join(mesh, ROUNDING * (high - low).norm());
}

/// Splits triangles at vertices on their open edges, no farther off than `within`; returns the places.
pub(super) fn join(mesh: &mut TriangleMesh, within: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    for _ in 0..MAX_ROUNDS {
        let on_edges = vertices_on_edges(mesh, &edge_uses(mesh), within);
        if on_edges.is_empty() {
            break;
        }
        for (triangle, (ends, between)) in on_edges {
            let vertices = between.iter().map(|&(_, vertex)| vertex);
            places.extend(
                vertices
                    .clone()
                    .map(|vertex| mesh.vertices[vertex as usize]),
            );
            split(mesh, triangle as usize, ends, vertices);
        }
    }
    places
}

type Between = Vec<(f64, u32)>;

/// Returns for each triangle one of its open edges with the vertices of other open edges between its ends.
fn vertices_on_edges(
    mesh: &TriangleMesh,
    uses: &[EdgeUse],
    within: f64,
) -> BTreeMap<u32, ([u32; 2], Between)> {
    let mut found: BTreeMap<u32, ([u32; 2], Between)> = BTreeMap::new();
    let open = by_edge(uses).filter(|edge| edge.len() == 1);
    let open: Vec<EdgeUse> = open.map(|edge| edge[0]).collect();
    // Triangles that share no edges do not form a surface with a few joints.
    if open.len() > mesh.triangles.len() {
        return found;
    }
    // Edges as flat triangles, for the tree of boxes.
    let lines = open
        .iter()
        .map(|edge| [edge.ends[0], edge.ends[1], edge.ends[1]]);
    let lines = TriangleMesh {
        vertices: mesh.vertices.clone(),
        triangles: lines.collect(),
    };
    BoxTree::new(&lines, within).for_close_pairs(|one, other| {
        for (edge, other) in [(&open[one], &open[other]), (&open[other], &open[one])] {
            let triangle = mesh.triangles[edge.triangle as usize];
            let ends = other.ends.into_iter().filter(|end| !triangle.contains(end));
            for vertex in ends {
                if let Some(share) = share_along(mesh, edge.ends, vertex, within) {
                    let first = || (edge.ends, Vec::new());
                    let (ends, between) = found.entry(edge.triangle).or_insert_with(first);
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

/// Returns the share of the way along an edge at which a vertex lies, if it lies on it and at none of its ends.
fn share_along(mesh: &TriangleMesh, ends: [u32; 2], vertex: u32, within: f64) -> Option<f64> {
    let [from, to] = ends.map(|end| mesh.vertices[end as usize]);
    let (way, at) = (to - from, mesh.vertices[vertex as usize] - from);
    let share = at.dot(&way) / way.norm_squared();
    let margin = within / way.norm();
    let is_on = (at - way * share).norm() <= within && share > margin && share < 1.0 - margin;
    is_on.then_some(share)
}

fn split(
    mesh: &mut TriangleMesh,
    triangle: usize,
    [from, to]: [u32; 2],
    between: impl Iterator<Item = u32>,
) {
    let whole = mesh.triangles[triangle];
    let chain: Vec<u32> = [from].into_iter().chain(between).chain([to]).collect();
    let mut parts = chain.windows(2).map(|ends| {
        whole.map(|corner| match corner {
            _ if corner == from => ends[0],
            _ if corner == to => ends[1],
            tip => tip,
        })
    });
    if let Some(first) = parts.next() {
        mesh.triangles[triangle] = first;
    }
    mesh.triangles.extend(parts);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_frame_is_filled_but_for_its_hole() {
        let square = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
        let places = square(3.0)
            .into_iter()
            .chain(square(2.0))
            .chain(square(1.0));
        let mut mesh = TriangleMesh {
            vertices: places.map(|[x, z]| Vec3::new(x, 5.0, z)).collect(),
            triangles: Vec::new(),
        };
        let loops = [vec![0, 1, 2, 3], vec![4, 5, 6, 7], vec![8, 9, 10, 11]];
        fill(&mut mesh, &loops, &-Vec3::y());
        let areas = (0..mesh.triangles.len()).map(|t| {
            let [a, b, c] = mesh.corners(t);
            (b - a).cross(&(c - a)).y / 2.0
        });
        let area: f64 = areas.sum();
        assert!((area + 36.0 - 16.0 + 4.0).abs() < 1e-12, "{area}");
    }
}
