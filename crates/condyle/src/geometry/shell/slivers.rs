//! Triangles thinner than rounding.

use std::collections::BTreeSet;

use super::weld::rename;
use crate::{Vec3, geometry::triangle_mesh::TriangleMesh};

/// Vertices with more triangles around than this are left alone: the tip of a fan.
const MOST_AROUND: usize = 64;
/// A collapsed edge keeps those beside it from collapsing in the same round; more rounds help nobody.
const ROUNDS: usize = 8;

/// Collapses the edges shorter than `thinnest`, where the surface stays what it is; gives where the slivers
/// are, with those left.
pub(super) fn collapse_slivers(mesh: &mut TriangleMesh, thinnest: f64) -> Vec<Vec3> {
    let thin: Vec<usize> = (0..mesh.triangles.len())
        .filter(|&triangle| is_thin(&mesh.corners(triangle), thinnest))
        .collect();
    let places = thin.iter().map(|&t| middle(&mesh.corners(t))).collect();
    if thin.is_empty() {
        return places;
    }
    for _ in 0..ROUNDS {
        if collapse_some(mesh, thinnest) == 0 {
            break;
        }
    }
    places
}

/// Twice the area over the longest edge is the height.
fn is_thin(corners: &[Vec3; 3], thinnest: f64) -> bool {
    let [a, b, c] = corners;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() < thinnest * longest
}

fn middle([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (a + b + c) / 3.0
}

/// Collapses short edges that are not beside one another; gives how many.
fn collapse_some(mesh: &mut TriangleMesh, thinnest: f64) -> usize {
    let around = triangles_around(mesh);
    let mut stands_for: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut is_settled = vec![false; mesh.vertices.len()];
    let mut collapsed = 0;
    for triangle in &mesh.triangles {
        for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|i: usize| triangle[i])) {
            let way = mesh.vertices[b as usize] - mesh.vertices[a as usize];
            let stars = [a, b].map(|end| &around[end as usize]);
            if a == b || way.norm() >= thinnest || stars.iter().any(|star| star.len() > MOST_AROUND)
            {
                continue;
            }
            let [one, other] = stars.map(|star| neighbours(mesh, star));
            let is_free = one
                .union(&other)
                .all(|&vertex| !is_settled[vertex as usize]);
            if is_free && keeps_the_surface(mesh, stars, [&one, &other], [a, b]) {
                one.union(&other)
                    .for_each(|&vertex| is_settled[vertex as usize] = true);
                stands_for[a.max(b) as usize] = a.min(b);
                collapsed += 1;
            }
        }
    }
    rename(mesh, &stands_for);
    mesh.triangles
        .retain(|[a, b, c]| a != b && b != c && c != a);
    collapsed
}

/// The vertices beside both ends are the tips of the triangles on the edge, and no others: then the surface
/// hangs together after the collapse as before.
fn keeps_the_surface(
    mesh: &TriangleMesh,
    [star, _]: [&Vec<u32>; 2],
    [one, other]: [&BTreeSet<u32>; 2],
    ends: [u32; 2],
) -> bool {
    let on_edge = star.iter().map(|&t| mesh.triangles[t as usize]);
    let on_edge = on_edge.filter(|corners| ends.iter().all(|end| corners.contains(end)));
    let tips: BTreeSet<u32> = on_edge
        .flatten()
        .filter(|corner| !ends.contains(corner))
        .collect();
    let beside: BTreeSet<u32> = one
        .intersection(other)
        .copied()
        .filter(|v| !ends.contains(v))
        .collect();
    tips == beside
}

fn neighbours(mesh: &TriangleMesh, star: &[u32]) -> BTreeSet<u32> {
    star.iter()
        .flat_map(|&t| mesh.triangles[t as usize])
        .collect()
}

fn triangles_around(mesh: &TriangleMesh) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); mesh.vertices.len()];
    for (number, triangle) in (0..).zip(&mesh.triangles) {
        triangle
            .iter()
            .for_each(|&vertex| around[vertex as usize].push(number));
    }
    around
}
