//! Simplification of a body for pictures.

use std::collections::BTreeMap;

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Cosine of the angle, 30 degrees, from which an edge is visibly sharp.
const SHARP_COSINE: f64 = 0.866;
/// Factor on the edge of the grid, and how often it is applied: where border and sharp edges take many triangles, larger
/// cubes would spoil the surface between them.
const WIDER: f64 = 1.1;
const MAX_WIDENINGS: i32 = 3;

/// The vertices that become one: those in a cube of a grid, or a single one of the border.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Cell {
    Cube([i64; 3]),
    Border(u32),
}

/// Returns a body of at most `max` triangles, or of more if border and sharp edges need them; a clone if the body has no
/// more than `max`.
///
/// Border and sharp edges are unchanged. In each cube of a grid, the other vertices are replaced by the one nearest to
/// their mean, so that all vertices stay on the surface, and a triangle of edge `h` deviates from a surface of radius
/// `R` by up to `h^2 / (8 R)`.
pub fn coarser(body: &TriangleMesh, max: usize) -> TriangleMesh {
    if body.triangles.len() <= max {
        return body.clone();
    }
    // A cube cuts a square out of the surface, which becomes two triangles.
    let edge = (2.0 * area(body) / max as f64).sqrt();
    let border = border(body);
    let mut coarse = clustered(body, edge, &border);
    for times in 1..=MAX_WIDENINGS {
        if coarse.triangles.len() <= max {
            break;
        }
        coarse = clustered(body, edge * WIDER.powi(times), &border);
    }
    coarse
}

fn area(body: &TriangleMesh) -> f64 {
    let normals = (0..body.triangles.len()).map(|triangle| normal(body, triangle));
    normals.map(|normal| normal.norm() / 2.0).sum()
}

/// Returns the normal of a triangle, twice its area long.
fn normal(body: &TriangleMesh, triangle: usize) -> Vec3 {
    let [a, b, c] = body.corners(triangle);
    (b - a).cross(&(c - a))
}

/// Returns true for each vertex on an edge of a single triangle or on a sharp edge.
fn border(body: &TriangleMesh) -> Vec<bool> {
    let of_triangle = |(number, &[a, b, c]): (usize, &[u32; 3])| {
        let normal = normal(body, number).normalize();
        [(a, b), (b, c), (c, a)].map(|(from, to)| ((from.min(to), from.max(to)), normal))
    };
    let triangles = body.triangles.iter().enumerate();
    let mut edges: Vec<_> = triangles.flat_map(of_triangle).collect();
    edges.sort_by_key(|(edge, _)| *edge);
    let mut border = vec![false; body.vertices.len()];
    for same in edges.chunk_by(|one, next| one.0 == next.0) {
        let is_sharp = |pair: &[(_, Vec3)]| pair[0].1.dot(&pair[1].1) < SHARP_COSINE;
        if same.len() == 1 || same.windows(2).any(is_sharp) {
            let (a, b) = same[0].0;
            border[a as usize] = true;
            border[b as usize] = true;
        }
    }
    border
}

fn clustered(body: &TriangleMesh, edge: f64, border: &[bool]) -> TriangleMesh {
    let cell = |(vertex, is_border): (u32, &bool)| match is_border {
        true => Cell::Border(vertex),
        false => {
            let place = <[f64; 3]>::from(body.vertices[vertex as usize] / edge);
            Cell::Cube(place.map(|at| at.floor() as i64))
        }
    };
    let cells: Vec<Cell> = (0..).zip(border).map(cell).collect();
    // Sorted cells give the same order of vertices on every machine.
    let mut members: BTreeMap<Cell, Vec<Vec3>> = BTreeMap::new();
    for (vertex, cell) in body.vertices.iter().zip(&cells) {
        members.entry(*cell).or_default().push(*vertex);
    }
    let place: BTreeMap<Cell, u32> = members.keys().copied().zip(0..).collect();
    let renumbered = |triangle: &[u32; 3]| triangle.map(|vertex| place[&cells[vertex as usize]]);
    let mut triangles: Vec<_> = body.triangles.iter().map(renumbered).collect();
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    // Pairs of coincident triangles face both ways and are removed: a closed surface stays closed.
    let sorted = |triangle: &[u32; 3]| {
        let mut corners = *triangle;
        corners.sort_unstable();
        corners
    };
    triangles.sort_by_key(sorted);
    let same = triangles.chunk_by(|one, next| sorted(one) == sorted(next));
    let odd = same.filter(|same| same.len() % 2 == 1);
    TriangleMesh {
        triangles: odd.map(|same| same[0]).collect(),
        vertices: members.values().map(|vertices| middle(vertices)).collect(),
    }
}

fn middle(vertices: &[Vec3]) -> Vec3 {
    let mean = vertices.iter().sum::<Vec3>() / vertices.len() as f64;
    let away = |vertex: &Vec3| (vertex - mean).norm_squared();
    let nearest = vertices.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.copied().unwrap_or(mean)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Radius of a tube, as that of a condyle, and of the ring that it is bent to, mm.
    const RADIUS_MM: f64 = 25.0;
    const RING_MM: f64 = 30.0;

    fn ring() -> TriangleMesh {
        let (along, around) = (160_u32, 120_u32);
        let at = |i: u32, j: u32| {
            let (way, turn) = (
                TAU * f64::from(i) / f64::from(along),
                TAU * f64::from(j) / f64::from(around),
            );
            let out = RING_MM + RADIUS_MM * turn.cos();
            Vec3::new(out * way.cos(), RADIUS_MM * turn.sin(), out * way.sin())
        };
        let nodes = (0..along).flat_map(|i| (0..around).map(move |j| at(i, j)));
        let node = |i: u32, j: u32| i % along * around + j % around;
        let quad = |i: u32, j: u32| {
            let [a, b, c, d] = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)];
            let [a, b, c, d] = [a, b, c, d].map(|(i, j)| node(i, j));
            [[a, b, c], [a, c, d]]
        };
        let quads = (0..along).flat_map(|i| (0..around).flat_map(move |j| quad(i, j)));
        TriangleMesh {
            vertices: nodes.collect(),
            triangles: quads.collect(),
        }
    }

    #[test]
    fn a_coarse_ring_is_closed_and_within_its_stated_deviation() {
        let coarse = coarser(&ring(), 6000);
        assert!(coarse.triangles.len() <= 6000 && coarse.triangles.len() > 3000);
        let mut edges = BTreeMap::new();
        for [a, b, c] in &coarse.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from.min(to), from.max(to))).or_insert(0) += 1;
            }
        }
        assert!(edges.values().all(|count| count % 2 == 0), "it has a hole");
        let middles = coarse.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|node| coarse.vertices[node as usize]);
            (a + b + c) / 3.0
        });
        let off = middles.map(|middle| {
            let out = middle.x.hypot(middle.z) - RING_MM;
            (out.hypot(middle.y) - RADIUS_MM).abs()
        });
        let most = off.fold(0.0, f64::max);
        assert!(most < 0.35, "{most}");
    }

    #[test]
    fn a_border_stays_where_it_is() {
        let mut open = ring();
        let half = open.triangles.len() / 2;
        open.triangles.truncate(half);
        let coarse = coarser(&open, 4000);
        let border = border(&open);
        let places = open.vertices.iter().zip(&border).filter(|(_, is)| **is);
        for (place, _) in places {
            assert!(coarse.vertices.contains(place));
        }
        assert!(coarse.triangles.len() <= 4000);
    }

    #[test]
    fn the_edges_of_a_box_stay_where_they_are() {
        // Two sides of a box, each of many squares.
        let side = 40_u32;
        let at = |i: u32, j: u32| {
            let (i, j) = (f64::from(i), f64::from(j));
            let half = f64::from(side) / 2.0;
            Vec3::new(j, (i - half).max(0.0), (half - i).max(0.0))
        };
        let nodes = (0..=side).flat_map(|i| (0..=side).map(move |j| at(i, j)));
        let node = |i: u32, j: u32| i * (side + 1) + j;
        let quad = |i: u32, j: u32| {
            let [a, b, c, d] = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)];
            let [a, b, c, d] = [a, b, c, d].map(|(i, j)| node(i, j));
            [[a, b, c], [a, c, d]]
        };
        let quads = (0..side).flat_map(|i| (0..side).flat_map(move |j| quad(i, j)));
        let folded = TriangleMesh {
            vertices: nodes.collect(),
            triangles: quads.collect(),
        };
        let coarse = coarser(&folded, 1000);
        assert!(coarse.triangles.len() <= 1000);
        // Both sides are covered: areas as vectors add up to the same.
        let vector = |body: &TriangleMesh| -> Vec3 {
            let corners = |triangle: &[u32; 3]| triangle.map(|node| body.vertices[node as usize]);
            let corners = body.triangles.iter().map(corners);
            corners.map(|[a, b, c]| (b - a).cross(&(c - a))).sum()
        };
        assert!((vector(&coarse) - vector(&folded)).norm() < 1e-9 * area(&folded));
        for j in 0..=side {
            assert!(coarse.vertices.contains(&at(side / 2, j)));
        }
    }

    #[test]
    fn a_body_of_few_triangles_stays_as_it_is() {
        let ring = ring();
        let same = coarser(&ring, ring.triangles.len());
        assert_eq!(same.triangles, ring.triangles);
    }
}
