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

/// The longest loop of a piece is its rim, and no hole, if it is longer than this share of the piece, corner to corner.
const RIM: f64 = 1.0 / 3.0;

/// Closes the holes where nothing touches, flat from edge to edge, and judges all.
pub(super) fn close_holes(mesh: &mut TriangleMesh, pieces: &[Piece], judge: &mut Judge) {
    if pieces.iter().all(|piece| !piece.is_open) {
        return;
    }
    let mut filled = false;
    for around in holes(mesh, pieces) {
        let places: Vec<Vec3> = around.iter().map(|&v| mesh.vertices[v as usize]).collect();
        let middle = places.iter().sum::<Vec3>() / places.len() as f64;
        let matters = judge.judge(mesh, DefectKind::Hole, middle, &places);
        let normal = area_vector(&places).try_normalize(0.0);
        if let Some(normal) = normal.filter(|_| !matters) {
            fill(mesh, &[around], &-normal);
            filled = true;
        }
    }
    if filled {
        join_filled(mesh);
    }
}

/// The loops that are not the rim of an open piece.
fn holes(mesh: &TriangleMesh, pieces: &[Piece]) -> Vec<Vec<u32>> {
    let mut piece_of = vec![0; mesh.vertices.len()];
    for (number, piece) in pieces.iter().enumerate() {
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&t| mesh.triangles[t as usize]);
        corners.for_each(|vertex| piece_of[vertex as usize] = number);
    }
    let mut loops = vec![Vec::new(); pieces.len()];
    for around in edge_report(mesh).boundary_loops {
        loops[piece_of[around[0] as usize]].push(around);
    }
    for (piece, loops) in pieces.iter().zip(&mut loops) {
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&t| mesh.triangles[t as usize]);
        let whole = extent(mesh, corners);
        let sizes: Vec<f64> = loops
            .iter()
            .map(|around| extent(mesh, around.iter().copied()))
            .collect();
        let longest = (0..sizes.len()).max_by(|&one, &other| sizes[one].total_cmp(&sizes[other]));
        if let Some(rim) = longest.filter(|&rim| sizes[rim] > RIM * whole) {
            loops.remove(rim);
        }
    }
    loops
        .into_iter()
        .flatten()
        .filter(|around| around.len() > 2)
        .collect()
}

/// Diagonal of the box around some vertices.
fn extent(mesh: &TriangleMesh, vertices: impl Iterator<Item = u32>) -> f64 {
    let (low, high) = bounds(vertices.map(|vertex| &mesh.vertices[vertex as usize]));
    (high - low).norm()
}

/// Twice the area that a loop bounds, along its normal.
fn area_vector(places: &[Vec3]) -> Vec3 {
    let next = places.iter().cycle().skip(1);
    let from = places[0];
    places
        .iter()
        .zip(next)
        .map(|(one, other)| (one - from).cross(&(other - from)))
        .sum()
}

/// Adds the triangles inside the loops, of which those within others are holes, seen in a plane of this normal;
/// the triangles face along it.
pub(super) fn fill(mesh: &mut TriangleMesh, loops: &[Vec<u32>], normal: &Vec3) {
    let axes = across(normal);
    let rings: Vec<Ring> = loops
        .iter()
        .map(|around| Ring::new(mesh, around, &axes))
        .collect();
    let depths: Vec<usize> = rings.iter().map(|ring| ring.depth(&rings)).collect();
    let of_depth = |depth: usize| {
        rings
            .iter()
            .zip(&depths)
            .filter(move |(_, own)| **own == depth)
    };
    for (outer, &depth) in rings
        .iter()
        .zip(&depths)
        .filter(|(_, depth)| *depth % 2 == 0)
    {
        let holes = of_depth(depth + 1)
            .map(|(ring, _)| ring)
            .filter(|ring| outer.contains(ring));
        add_polygon(mesh, outer, &holes.collect::<Vec<_>>());
    }
}

/// Two directions across a normal, right-handed with it.
fn across(normal: &Vec3) -> [Vec3; 2] {
    let first = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    [first, normal.cross(&first).normalize()]
}

/// A loop seen in the plane.
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

    /// In how many others it lies.
    fn depth(&self, all: &[Self]) -> usize {
        all.iter().filter(|other| other.contains(self)).count()
    }

    fn contains(&self, other: &Self) -> bool {
        !std::ptr::eq(self, other) && self.surrounds(other.places[0])
    }

    /// By the parity of the edges that a ray from the point crosses.
    fn surrounds(&self, [x, y]: [f64; 2]) -> bool {
        let is_beside = |axis: usize, at: f64| at < self.low[axis] || at > self.high[axis];
        if is_beside(0, x) || is_beside(1, y) {
            return false;
        }
        let next = self.places.iter().cycle().skip(1);
        let crosses = |[x1, y1]: [f64; 2], [x2, y2]: [f64; 2]| {
            (y1 > y) != (y2 > y) && x < x1 + (y - y1) / (y2 - y1) * (x2 - x1)
        };
        let crossed = self
            .places
            .iter()
            .zip(next)
            .filter(|&(&one, &other)| crosses(one, other));
        crossed.count() % 2 == 1
    }
}

fn add_polygon(mesh: &mut TriangleMesh, outer: &Ring, holes: &[&Ring]) {
    let mut vertices = outer.vertices.clone();
    let mut places = outer.places.clone();
    let mut starts = Vec::new();
    for hole in holes {
        starts.push(vertices.len() as u32);
        vertices.extend(&hole.vertices);
        places.extend(&hole.places);
    }
    let mut corners: Vec<u32> = Vec::new();
    Earcut::new().earcut(places.iter().copied(), &starts, &mut corners);
    for triangle in corners.chunks_exact(3) {
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
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
