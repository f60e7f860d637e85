//! Simplification of a body for pictures.

use std::{cmp::Reverse, collections::BinaryHeap};

use crate::{
    CurvedMesh, Vec3,
    repair::{by_edge, drop_unused, edge_uses},
    triangle_mesh::TriangleMesh,
};

/// Deviation of a body that is simplified for a picture, mm: less than a pixel of a picture that shows the whole body.
pub const PICTURE_DEVIATION_MM: f64 = 0.1;
/// Cosine of the largest angle, 25 degrees, between a triangle and the original triangle that it came from: shading depends
/// on normals more than on places.
const LEAST_COSINE: f64 = 0.906;
/// Cost of the length of an edge, relative to that of a distance: on a plane, the shortest edges collapse first, which
/// gives triangles of similar sizes.
const COST_OF_LENGTH: f64 = 1e-4;

/// Returns a body of fewer triangles that differs from `body` by at most `deviation_mm`.
///
/// Edges collapse in the order of their quadric error [garland-heckbert1997], computed from the present triangles
/// [lindstrom-turk1998]. The vertices of the result are vertices of `body`; those of borders, and of edges with more than
/// two triangles, all stay, and a closed body stays closed. Each vertex of `body` is within `deviation_mm` of the result, and
/// the middles of the triangles and edges of the result are within `deviation_mm` of `body`.
pub fn coarser(body: &TriangleMesh, deviation_mm: f64) -> TriangleMesh {
    let mut collapses = Collapses::new(body, deviation_mm);
    while let Some(vertex) = collapses.cheapest() {
        collapses.remove(vertex);
    }
    collapses.into_mesh()
}

struct Collapses<'a> {
    body: &'a TriangleMesh,
    /// The triangles of the body around each vertex.
    originals: Vec<Vec<u32>>,
    triangles: Vec<[u32; 3]>,
    /// The normals of the present triangles, twice their areas long, and those lengths.
    planes: Vec<(Vec3, f64)>,
    /// The unit normals of the original triangles.
    normals: Vec<Vec3>,
    /// The present triangles around each vertex; none around a removed one.
    around: Vec<Vec<u32>>,
    is_fixed: Vec<bool>,
    /// The removed vertices that are next to each triangle.
    removed: Vec<Vec<u32>>,
    /// The number of changes around each vertex: candidates with a smaller one are void.
    stamps: Vec<u32>,
    /// The bits of the cost, which increase with it as it is never negative, the vertex and its stamp; the least cost first.
    queue: BinaryHeap<Reverse<(u64, u32, u32)>>,
    deviation2: f64,
}

impl<'a> Collapses<'a> {
    fn new(body: &'a TriangleMesh, deviation_mm: f64) -> Self {
        let triangles = 0..body.triangles.len();
        let planes: Vec<_> = triangles
            .map(|triangle| plane(&body.corners(triangle)))
            .collect();
        let unit = |(normal, _): &(Vec3, f64)| normal.try_normalize(0.0).unwrap_or_default();
        let mut collapses = Self {
            body,
            originals: body.triangles_around(),
            triangles: body.triangles.clone(),
            normals: planes.iter().map(unit).collect(),
            planes,
            around: body.triangles_around(),
            is_fixed: border(body),
            removed: vec![Vec::new(); body.triangles.len()],
            stamps: vec![0; body.vertices.len()],
            queue: BinaryHeap::new(),
            deviation2: deviation_mm.powi(2),
        };
        for vertex in 0..body.vertices.len() as u32 {
            collapses.offer(vertex);
        }
        collapses
    }

    /// Puts a vertex into the queue, with the cost of its cheapest collapse, unless it is fixed.
    fn offer(&mut self, vertex: u32) {
        if !self.is_fixed[vertex as usize]
            && let Some(cost) = self.least_cost(vertex)
        {
            let stamp = self.stamps[vertex as usize];
            self.queue.push(Reverse((cost.to_bits(), vertex, stamp)));
        }
    }

    /// Takes the vertex of least cost from the queue; those whose surroundings have changed since are dropped.
    fn cheapest(&mut self) -> Option<u32> {
        loop {
            let Reverse((_, vertex, stamp)) = self.queue.pop()?;
            if stamp == self.stamps[vertex as usize] {
                return Some(vertex);
            }
        }
    }

    fn least_cost(&self, vertex: u32) -> Option<f64> {
        let neighbours = self.neighbours(vertex).into_iter();
        let costs = neighbours.map(|to| self.cost(vertex, to));
        costs.min_by(f64::total_cmp)
    }

    /// Returns the vertices that `vertex` may move to, each after its cost, the cheapest first.
    fn targets(&self, vertex: u32) -> Vec<(f64, u32)> {
        let neighbours = self.neighbours(vertex).into_iter();
        let mut targets: Vec<_> = neighbours.map(|to| (self.cost(vertex, to), to)).collect();
        targets.sort_by(|one, two| one.0.total_cmp(&two.0));
        targets
    }

    /// Returns the sum of area times squared distance to the planes of the triangles around `from`, at `to`.
    fn cost(&self, from: u32, to: u32) -> f64 {
        let edge = self.body.vertices[to as usize] - self.body.vertices[from as usize];
        let around = self.around[from as usize].iter();
        let planes: f64 = around
            .map(|&triangle| self.off_plane(triangle, &edge))
            .sum();
        planes + COST_OF_LENGTH * edge.norm_squared()
    }

    fn off_plane(&self, triangle: u32, edge: &Vec3) -> f64 {
        let (normal, length) = self.planes[triangle as usize];
        normal.dot(edge).powi(2) / length.max(f64::MIN_POSITIVE)
    }

    fn neighbours(&self, vertex: u32) -> Vec<u32> {
        let around = &self.around[vertex as usize];
        let mut neighbours = Vec::with_capacity(2 * around.len());
        for &triangle in around {
            for corner in self.triangles[triangle as usize] {
                if corner != vertex && !neighbours.contains(&corner) {
                    neighbours.push(corner);
                }
            }
        }
        neighbours.sort_unstable();
        neighbours
    }

    fn places(&self, corners: [u32; 3]) -> [Vec3; 3] {
        corners.map(|vertex| self.body.vertices[vertex as usize])
    }

    /// Removes a vertex by its cheapest permitted collapse, if there is one.
    fn remove(&mut self, from: u32) {
        for (_, to) in self.targets(from) {
            if !self.is_manifold(from, to) {
                continue;
            }
            let moved = self.moved(from, to);
            if self.keeps_normals(&moved)
                && let Some(next_to) = self.next_to(from, &moved)
                && self.keeps_middles(&moved, &next_to)
            {
                return self.collapse(from, &moved, &next_to);
            }
        }
    }

    /// Returns whether a collapse keeps every edge at two triangles.
    fn is_manifold(&self, from: u32, to: u32) -> bool {
        let (of_from, of_to) = (self.neighbours(from), self.neighbours(to));
        let shared = of_from
            .iter()
            .filter(|one| of_to.binary_search(one).is_ok());
        // With three triangles around it, the collapse could leave two coincident triangles.
        self.around[from as usize].len() > 3 && shared.count() == 2
    }

    /// Returns the triangles that a collapse leaves, with their new corners.
    fn moved(&self, from: u32, to: u32) -> Vec<(u32, [u32; 3])> {
        let renamed = |corner| if corner == from { to } else { corner };
        let around = self.around[from as usize].iter();
        let triangles = around.map(|&triangle| (triangle, self.triangles[triangle as usize]));
        let left = triangles.filter(|(_, corners)| !corners.contains(&to));
        left.map(|(triangle, corners)| (triangle, corners.map(renamed)))
            .collect()
    }

    fn keeps_normals(&self, moved: &[(u32, [u32; 3])]) -> bool {
        moved.iter().all(|&(triangle, corners)| {
            let (normal, size) = plane(&self.places(corners));
            size > 0.0 && self.normals[triangle as usize].dot(&normal) >= LEAST_COSINE * size
        })
    }

    /// Returns whether the middles of the moved triangles, and of their edges, are near the body.
    fn keeps_middles(&self, moved: &[(u32, [u32; 3])], next_to: &[(u32, u32)]) -> bool {
        let removed = || next_to.iter().map(|(vertex, _)| *vertex);
        moved.iter().all(|&(_, corners)| {
            let [a, b, c] = self.places(corners);
            let middles = [a + b, b + c, c + a].map(|sum| sum / 2.0);
            let mut middles = middles.into_iter().chain([(a + b + c) / 3.0]);
            middles.all(|middle| self.is_near_body(removed().chain(corners), &middle))
        })
    }

    /// Returns whether a point is near the original triangles around the nearest of some vertices.
    fn is_near_body(&self, vertices: impl Iterator<Item = u32>, point: &Vec3) -> bool {
        let away = |vertex: u32| (self.body.vertices[vertex as usize] - point).norm_squared();
        let nearest = vertices.min_by(|&one, &two| away(one).total_cmp(&away(two)));
        let around = nearest.map(|vertex| &self.originals[vertex as usize]);
        let mut around = around.into_iter().flatten();
        around.any(|&triangle| self.is_near(&self.body.corners(triangle as usize), point))
    }

    fn is_near(&self, corners: &[Vec3; 3], point: &Vec3) -> bool {
        CurvedMesh::distance2_to_triangle(corners, point) <= self.deviation2
    }

    /// Returns each vertex that a collapse removes or has to assign again, with the nearest of the moved triangles; `None`
    /// if one is too far from all.
    fn next_to(&self, from: u32, moved: &[(u32, [u32; 3])]) -> Option<Vec<(u32, u32)>> {
        let around = self.around[from as usize].iter();
        let removed = around.flat_map(|&triangle| &self.removed[triangle as usize]);
        let vertices = removed.chain([&from]);
        vertices
            .map(|&vertex| Some((vertex, self.nearest(vertex, moved)?)))
            .collect()
    }

    fn nearest(&self, vertex: u32, moved: &[(u32, [u32; 3])]) -> Option<u32> {
        let point = &self.body.vertices[vertex as usize];
        let distance2 = |corners| CurvedMesh::distance2_to_triangle(&self.places(corners), point);
        let distances = moved
            .iter()
            .map(|&(triangle, corners)| (distance2(corners), triangle));
        let nearest = distances.min_by(|one, two| one.0.total_cmp(&two.0))?;
        (nearest.0 <= self.deviation2).then_some(nearest.1)
    }

    fn collapse(&mut self, from: u32, moved: &[(u32, [u32; 3])], next_to: &[(u32, u32)]) {
        let ring = self.neighbours(from);
        self.replace(from, &ring, moved);
        for &(vertex, triangle) in next_to {
            self.removed[triangle as usize].push(vertex);
        }
        for vertex in ring {
            self.stamps[vertex as usize] += 1;
            self.offer(vertex);
        }
    }

    /// Replaces the triangles around `from`.
    fn replace(&mut self, from: u32, ring: &[u32], moved: &[(u32, [u32; 3])]) {
        let before = std::mem::take(&mut self.around[from as usize]);
        for &triangle in &before {
            self.removed[triangle as usize].clear();
        }
        for &vertex in ring {
            self.around[vertex as usize].retain(|triangle| !before.contains(triangle));
        }
        for &(triangle, corners) in moved {
            self.triangles[triangle as usize] = corners;
            self.planes[triangle as usize] = plane(&self.places(corners));
            for corner in corners {
                self.around[corner as usize].push(triangle);
            }
        }
    }

    fn into_mesh(self) -> TriangleMesh {
        let is_there = |triangle: &u32| {
            let [a, ..] = self.triangles[*triangle as usize];
            self.around[a as usize].contains(triangle)
        };
        let triangles = (0..self.triangles.len() as u32).filter(is_there);
        let triangles = triangles.map(|triangle| self.triangles[triangle as usize]);
        let mut mesh = TriangleMesh {
            triangles: triangles.collect(),
            vertices: self.body.vertices.clone(),
        };
        drop_unused(&mut mesh);
        mesh
    }
}

/// Returns the normal of a triangle, twice its area long, and its length.
fn plane([a, b, c]: &[Vec3; 3]) -> (Vec3, f64) {
    let normal = (b - a).cross(&(c - a));
    (normal, normal.norm())
}

/// Returns true for each vertex on an edge that has other than two triangles.
fn border(body: &TriangleMesh) -> Vec<bool> {
    let mut border = vec![false; body.vertices.len()];
    for same in by_edge(&edge_uses(body)).filter(|same| same.len() != 2) {
        for end in same[0].ends {
            border[end as usize] = true;
        }
    }
    border
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Radius of a tube, as that of a condyle, and of the ring that it is bent to, mm.
    const RADIUS_MM: f64 = 25.0;
    const RING_MM: f64 = 30.0;
    const DEVIATION_MM: f64 = PICTURE_DEVIATION_MM;

    fn grid(along: u32, around: u32, is_ring: bool, at: impl Fn(u32, u32) -> Vec3) -> TriangleMesh {
        let (rows, columns) = if is_ring {
            (along, around)
        } else {
            (along + 1, around + 1)
        };
        let nodes = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
        let vertices = nodes.map(|(i, j)| at(i, j)).collect();
        let node = |i: u32, j: u32| i % rows * columns + j % columns;
        let places = (0..along).flat_map(|i| (0..around).map(move |j| (i, j)));
        let corners =
            |(i, j)| [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)].map(|(i, j)| node(i, j));
        TriangleMesh::of_quads(vertices, places.map(corners))
    }

    fn ring() -> TriangleMesh {
        let (along, around) = (160, 120);
        grid(along, around, true, |i, j| {
            let turn = |at: u32, of: u32| TAU * f64::from(at) / f64::from(of);
            let (way, turn) = (turn(i, along), turn(j, around));
            let out = RING_MM + RADIUS_MM * turn.cos();
            Vec3::new(out * way.cos(), RADIUS_MM * turn.sin(), out * way.sin())
        })
    }

    /// Distance of a point from the surface of the ring, mm.
    fn off_ring(point: &Vec3) -> f64 {
        let out = point.x.hypot(point.z) - RING_MM;
        (out.hypot(point.y) - RADIUS_MM).abs()
    }

    fn area(body: &TriangleMesh) -> f64 {
        let areas =
            (0..body.triangles.len()).map(|triangle| plane(&body.corners(triangle)).1 / 2.0);
        areas.sum()
    }

    #[test]
    fn a_coarse_ring_is_closed_and_within_its_stated_deviation() {
        let coarse = coarser(&ring(), DEVIATION_MM);
        assert!(
            coarse.triangles.len() < ring().triangles.len() / 8,
            "{}",
            coarse.triangles.len()
        );
        assert!(
            border(&coarse).iter().all(|is_border| !is_border),
            "it has a hole"
        );
        let sag = RADIUS_MM * (1.0 - (TAU / 240.0).cos());
        for triangle in 0..coarse.triangles.len() {
            let [a, b, c] = coarse.corners(triangle);
            for point in [
                (a + b + c) / 3.0,
                (a + b) / 2.0,
                (b + c) / 2.0,
                (c + a) / 2.0,
            ] {
                assert!(
                    off_ring(&point) < DEVIATION_MM + 3.0 * sag,
                    "{}",
                    off_ring(&point)
                );
            }
        }
        let volume = coarse.signed_volume() / ring().signed_volume();
        assert!((volume - 1.0).abs() < 0.01, "{volume}");
    }

    #[test]
    fn every_vertex_is_near_the_coarse_body() {
        let (fine, coarse) = (ring(), coarser(&ring(), DEVIATION_MM));
        for vertex in fine.vertices.iter().step_by(97) {
            let corners = (0..coarse.triangles.len()).map(|triangle| coarse.corners(triangle));
            let distance2 =
                corners.map(|corners| CurvedMesh::distance2_to_triangle(&corners, vertex));
            let nearest = distance2.fold(f64::INFINITY, f64::min).sqrt();
            assert!(nearest <= DEVIATION_MM, "{nearest}");
        }
    }

    #[test]
    fn a_border_stays_where_it_is() {
        let mut open = ring();
        open.triangles.truncate(open.triangles.len() / 2);
        let coarse = coarser(&open, DEVIATION_MM);
        let places = open
            .vertices
            .iter()
            .zip(border(&open))
            .filter(|(_, is)| *is);
        for (place, _) in places {
            assert!(coarse.vertices.contains(place));
        }
        assert!(coarse.triangles.len() < open.triangles.len() / 4);
    }

    #[test]
    fn the_edges_of_a_box_stay_where_they_are() {
        // Two sides of a box, each of many squares.
        const SIDE: u32 = 40;
        let folded = grid(SIDE, SIDE, false, |i, j| {
            let (i, j) = (f64::from(i) - f64::from(SIDE) / 2.0, f64::from(j));
            Vec3::new(j, i.max(0.0), (-i).max(0.0))
        });
        let coarse = coarser(&folded, DEVIATION_MM);
        assert!(coarse.triangles.len() < folded.triangles.len() / 5);
        let vector = |body: &TriangleMesh| -> Vec3 {
            (0..body.triangles.len())
                .map(|triangle| plane(&body.corners(triangle)).0)
                .sum()
        };
        // Both sides are covered, and no triangle crosses the edge between them.
        assert!((vector(&coarse) - vector(&folded)).norm() < 1e-9 * area(&folded));
        assert!((area(&coarse) - area(&folded)).abs() < 1e-9 * area(&folded));
    }

    #[test]
    fn a_body_that_needs_its_triangles_keeps_them() {
        let block = TriangleMesh::block(Vec3::zeros(), Vec3::new(3.0, 2.0, 1.0));
        assert_eq!(coarser(&block, DEVIATION_MM).triangles, block.triangles);
        let empty = TriangleMesh::default();
        assert_eq!(coarser(&empty, DEVIATION_MM), empty);
    }
}
