//! Cuts a mesh at a height and closes it flat there.

use std::collections::BTreeMap;

use super::{
    edges::{by_edge, edge_uses},
    holes::{fill, join_filled},
};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Distance from the height within which vertices are moved onto it, mm: a thousandth of the wear of a test.
/// Otherwise slivers remain.
const ON_MM: f64 = 1e-4;

/// Removes the part of a mesh below a height along y, and closes the cut with triangles that face down.
pub(super) fn clip_below(mesh: &TriangleMesh, height_mm: f64) -> TriangleMesh {
    let mut vertices = mesh.vertices.clone();
    for at in &mut vertices {
        if (at.y - height_mm).abs() < ON_MM {
            at.y = height_mm;
        }
    }
    let mut triangles = Vec::new();
    // The vertex where an edge passes the height, the same for both triangles of the edge.
    let mut on_edge: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for &triangle in &mesh.triangles {
        let above = triangle.map(|vertex| vertices[vertex as usize].y - height_mm);
        if above.iter().all(|&height| height <= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(4);
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            if above[from] >= 0.0 {
                kept.push(triangle[from]);
            }
            if above[from] * above[to] < 0.0 {
                let [from, to] = [triangle[from], triangle[to]];
                let ends = [from.min(to), from.max(to)];
                kept.push(*on_edge.entry(ends).or_insert_with(|| {
                    let [a, b] = ends.map(|end| vertices[end as usize]);
                    let mut at = a + (b - a) * ((height_mm - a.y) / (b.y - a.y));
                    // Exactly, so that the open edges of the cut are found by their height.
                    at.y = height_mm;
                    vertices.push(at);
                    vertices.len() as u32 - 1
                }));
            }
        }
        for ends in kept[1..].windows(2) {
            triangles.push([kept[0], ends[0], ends[1]]);
        }
    }
    let mut cut = TriangleMesh {
        vertices,
        triangles,
    };
    let loops = loops_at(&cut, height_mm);
    fill(&mut cut, &loops, &-Vec3::y());
    join_filled(&mut cut);
    cut
}

/// Returns the loops of open edges at a height. Triangles may not agree yet, so edges have no direction.
fn loops_at(mesh: &TriangleMesh, height_mm: f64) -> Vec<Vec<u32>> {
    let lies_there = |vertex: u32| mesh.vertices[vertex as usize].y == height_mm;
    let mut neighbours: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for edge in by_edge(&edge_uses(mesh)) {
        let [a, b] = edge[0].ends;
        if edge.len() == 1 && lies_there(a) && lies_there(b) {
            neighbours.entry(a).or_default().push(b);
            neighbours.entry(b).or_default().push(a);
        }
    }
    let mut loops = Vec::new();
    while let Some((&start, ends)) = neighbours.first_key_value() {
        if ends.is_empty() {
            neighbours.remove(&start);
            continue;
        }
        // Along edges, each once, until the way ends or returns to its start.
        let mut around = vec![start];
        let mut at = start;
        while let Some(to) = neighbours.get_mut(&at).and_then(Vec::pop) {
            if let Some(back) = neighbours.get_mut(&to)
                && let Some(index) = back.iter().position(|&other| other == at)
            {
                back.swap_remove(index);
            }
            if to == start {
                break;
            }
            around.push(to);
            at = to;
        }
        if around.len() > 2 {
            loops.push(around);
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::repair::{
        checked_mesh,
        crossing::{Crossings, crossings},
        tests::{fine_block, joined},
    };

    #[test]
    fn verify_the_volume_above_a_height() {
        let body = TriangleMesh::block(Vec3::new(-2.0, -3.0, -1.0), Vec3::new(2.0, 5.0, 1.0));
        for height_mm in [-2.5, 0.0, 1.75] {
            let cut = checked_mesh(clip_below(&body, height_mm)).unwrap();
            assert!(cut.closed && !cut.turned_round);
            let volume = cut.mesh.signed_volume();
            assert!((volume - 8.0 * (5.0 - height_mm)).abs() < 1e-12, "{volume}");
        }
    }

    #[test]
    fn a_cut_through_straight_walls_of_many_triangles_is_closed() {
        let body = fine_block(Vec3::new(40.0, 8.0, 60.0), 2.0);
        for height_mm in [0.1, 1.0, 2.0, 4.7] {
            let cut = clip_below(&body, height_mm);
            assert!(by_edge(&edge_uses(&cut)).all(|edge| edge.len() == 2));
            let volume = cut.signed_volume();
            assert!(
                (volume - 2400.0 * (8.0 - height_mm)).abs() < 1e-9,
                "{volume}"
            );
        }
    }

    #[test]
    fn verify_a_hollow_stays_hollow() {
        let mut hollow = TriangleMesh::block(Vec3::new(-1.0, -4.0, -0.5), Vec3::new(1.0, 4.0, 0.5));
        hollow
            .triangles
            .iter_mut()
            .for_each(|triangle| triangle.swap(1, 2));
        let outer = TriangleMesh::block(Vec3::new(-2.0, -3.0, -1.0), Vec3::new(2.0, 5.0, 1.0));
        let cut = checked_mesh(clip_below(&joined(outer, hollow), 0.0)).unwrap();
        assert!((cut.mesh.signed_volume() - (40.0 - 8.0)).abs() < 1e-12);
    }

    #[test]
    fn a_flat_bottom_with_a_fine_outline_is_no_tangle() {
        let count = 750_u32;
        let rim = |y: f64| {
            (0..count).map(move |i| {
                let (sine, cosine) = (f64::from(i) / f64::from(count) * TAU).sin_cos();
                Vec3::new(26.0 * cosine, y, 40.0 * sine)
            })
        };
        let wall = (0..count).flat_map(|i| {
            let [low, next] = [i, (i + 1) % count];
            [[low, low + count, next], [next, low + count, next + count]]
        });
        let tube = TriangleMesh {
            vertices: rim(-5.0).chain(rim(9.0)).collect(),
            triangles: wall.collect(),
        };
        let cut = clip_below(&tube, 1.0);
        assert_eq!(cut.triangles.len(), 3 * 750 + 1500 - 2);
        assert_eq!(crossings(&cut), Crossings::default());
    }
}
