//! Triangles thinner than rounding.

use std::collections::BTreeSet;

use super::weld::rename;
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Vertices with more triangles around than this are left alone: the tip of a fan.
const MAX_AROUND: usize = 64;
/// A collapsed edge keeps those beside it from collapsing in the same round; more rounds help nobody.
const ROUNDS: usize = 8;

/// Collapses edges shorter than `thinnest`, where the surface stays what it is; gives where triangles went.
pub(super) fn collapse_slivers(mesh: &mut TriangleMesh, thinnest: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    for _ in 0..ROUNDS {
        let collapsed = collapse_some(mesh, thinnest);
        if collapsed.is_empty() {
            break;
        }
        places.extend(collapsed);
    }
    places
}

/// Collapses short edges that are not beside one another; gives where triangles went.
fn collapse_some(mesh: &mut TriangleMesh, thinnest: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    let short = short_edges(mesh, thinnest);
    if short.is_empty() {
        return places;
    }
    let around = triangles_around(mesh);
    let mut stands_for: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut is_settled = vec![false; mesh.vertices.len()];
    for [a, b] in short {
        let stars = [a, b].map(|end| &around[end as usize]);
        if stars.iter().any(|star| star.len() > MAX_AROUND) {
            continue;
        }
        let [one, other] = stars.map(|star| neighbours(mesh, star));
        let mut beside = one.union(&other);
        let is_free = beside.all(|&vertex| !is_settled[vertex as usize]);
        if is_free && keeps_the_surface(mesh, stars, [&one, &other], [a, b]) {
            for &vertex in one.union(&other) {
                is_settled[vertex as usize] = true;
            }
            stands_for[b as usize] = a;
            places.extend(on_edge(mesh, stars[0], [a, b]).map(|_| mesh.vertices[a as usize]));
        }
    }
    rename(mesh, &stands_for);
    mesh.triangles
        .retain(|[a, b, c]| a != b && b != c && c != a);
    places
}

/// The lower number first, each once.
fn short_edges(mesh: &TriangleMesh, thinnest: f64) -> BTreeSet<[u32; 2]> {
    let sides = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let is_short = |[a, b]: &[u32; 2]| {
        let way = mesh.vertices[*b as usize] - mesh.vertices[*a as usize];
        way.norm_squared() < thinnest * thinnest
    };
    sides
        .filter(is_short)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect()
}

/// The triangles of a star that have both ends.
fn on_edge<'a>(
    mesh: &'a TriangleMesh,
    star: &'a [u32],
    ends: [u32; 2],
) -> impl Iterator<Item = [u32; 3]> + 'a {
    let corners = star
        .iter()
        .map(|&triangle| mesh.triangles[triangle as usize]);
    corners.filter(move |corners| ends.iter().all(|end| corners.contains(end)))
}

/// The vertices beside both ends are the tips of the triangles on the edge, and no others: then the surface
/// hangs together after the collapse as before.
fn keeps_the_surface(
    mesh: &TriangleMesh,
    [star, _]: [&Vec<u32>; 2],
    [one, other]: [&BTreeSet<u32>; 2],
    ends: [u32; 2],
) -> bool {
    let tips: BTreeSet<u32> = on_edge(mesh, star, ends)
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
