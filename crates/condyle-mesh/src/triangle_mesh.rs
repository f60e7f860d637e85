//! A surface of triangles, the box around points, and one flat triangle: its closest point, its height over a place, and its
//! intersection with a ray.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::Vec3;

/// A surface of triangles, each anticlockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// Vertex positions, mm.
    pub vertices: Vec<Vec3>,
    /// Vertex numbers of each triangle, from 0.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Returns the surface of quads, each cut from its first corner to its third.
    pub fn of_quads(vertices: Vec<Vec3>, quads: impl IntoIterator<Item = [u32; 4]>) -> Self {
        let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        let triangles = quads.into_iter().flat_map(halves).collect();
        Self {
            vertices,
            triangles,
        }
    }

    /// Returns the positions of the three corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices[vertex as usize])
    }

    /// Returns the volume inside a closed surface; negative if the triangles face inwards.
    pub fn signed_volume(&self) -> f64 {
        self.volume_of(0..self.triangles.len())
    }

    pub(crate) fn volume_of(&self, triangles: impl Iterator<Item = usize>) -> f64 {
        // An origin on the mesh, so that a body far from the origin of its file loses no digits.
        let origin = self.vertices.first().copied().unwrap_or_default();
        triangles
            .map(|triangle| {
                let [a, b, c] = self.corners(triangle).map(|corner| corner - origin);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum()
    }

    /// Returns the lowest and highest coordinate along each axis.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        bounds(&self.vertices)
    }

    /// Returns the unit normal at each vertex: the sum over the triangles around of a x b / (a^2 b^2), with a
    /// and b the two edges that leave the vertex; exact for vertices on a sphere (Max 1999).
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        self.normals_of(&self.triangles, self.vertices.len())
    }

    /// Returns the same sums over the triangles at each of `count` numbers; `numbers_of` has those of the corners.
    pub(crate) fn normals_of(&self, numbers_of: &[[u32; 3]], count: usize) -> Vec<Vec3> {
        let mut normals = vec![Vec3::zeros(); count];
        for (triangle, numbers) in numbers_of.iter().enumerate() {
            let corners = self.corners(triangle);
            for i in 0..3 {
                let [a, b] = [1, 2].map(|step| corners[(i + step) % 3] - corners[i]);
                let weight = a.norm_squared() * b.norm_squared();
                // A corner with an edge of no length has no direction.
                if weight > 0.0 {
                    normals[numbers[i] as usize] += a.cross(&b) / weight;
                }
            }
        }
        normals
            .iter()
            .map(|normal| normal.try_normalize(0.0).unwrap_or_default())
            .collect()
    }

    pub(crate) fn triangles_around(&self) -> Vec<Vec<u32>> {
        let mut around = vec![Vec::new(); self.vertices.len()];
        for (triangle, vertices) in (0..).zip(&self.triangles) {
            for &vertex in vertices {
                around[vertex as usize].push(triangle);
            }
        }
        around
    }

    /// Moves every vertex by `map`, which must not mirror.
    pub fn mapped(mut self, map: impl Fn(&Vec3) -> Vec3) -> Self {
        self.vertices
            .iter_mut()
            .for_each(|vertex| *vertex = map(vertex));
        self
    }

    /// Divides every triangle in four at the middles of its sides, which `middle_of` places between two corners.
    pub fn in_four(&self, middle_of: impl Fn(&Vec3, &Vec3) -> Vec3) -> Self {
        self.divided(|_, _| true, middle_of)
    }

    /// Divides triangles at the middles of sides until no side is longer than `max_mm`, as in [`TriangleMesh::in_four`].
    pub fn with_sides_up_to(
        mut self,
        max_mm: f64,
        middle_of: impl Fn(&Vec3, &Vec3) -> Vec3,
    ) -> Self {
        let is_long = |a: &Vec3, b: &Vec3| (b - a).norm() > max_mm;
        loop {
            let count = self.triangles.len();
            self = self.divided(is_long, &middle_of);
            if self.triangles.len() == count {
                return self;
            }
        }
    }

    fn divided(
        &self,
        is_divided: impl Fn(&Vec3, &Vec3) -> bool,
        middle_of: impl Fn(&Vec3, &Vec3) -> Vec3,
    ) -> Self {
        let mut vertices = self.vertices.clone();
        // Only looked up: its order does not matter.
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32| {
            let ends = [a.min(b), a.max(b)];
            let [from, to] = ends.map(|end| self.vertices[end as usize]);
            is_divided(&from, &to).then(|| {
                *middles.entry(ends).or_insert_with(|| {
                    vertices.push(middle_of(&from, &to));
                    vertices.len() as u32 - 1
                })
            })
        };
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            match (middle(a, b), middle(b, c), middle(c, a)) {
                (Some(ab), Some(bc), Some(ca)) => {
                    triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
                }
                (Some(ab), Some(bc), None) => {
                    triangles.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]);
                }
                (None, Some(bc), Some(ca)) => {
                    triangles.extend([[bc, c, ca], [b, bc, ca], [b, ca, a]]);
                }
                (Some(ab), None, Some(ca)) => {
                    triangles.extend([[ca, a, ab], [c, ca, ab], [c, ab, b]]);
                }
                (Some(ab), None, None) => triangles.extend([[a, ab, c], [ab, b, c]]),
                (None, Some(bc), None) => triangles.extend([[b, bc, a], [bc, c, a]]),
                (None, None, Some(ca)) => triangles.extend([[c, ca, b], [ca, a, b]]),
                (None, None, None) => triangles.push([a, b, c]),
            }
        }
        Self {
            vertices,
            triangles,
        }
    }

    /// Returns the body of revolution about y through the points (radius, height) of a profile, in `around` facets around.
    ///
    /// It faces out if the material lies on the left of the profile, which starts and ends near the axis if it is closed.
    pub fn revolved(profile: &[(f64, f64)], around: u32) -> Self {
        let angle = |n: u32| TAU * f64::from(n) / f64::from(around);
        let ring = |&(radius, height): &(f64, f64)| {
            (0..around).map(move |n| {
                let (sine, cosine) = angle(n).sin_cos();
                Vec3::new(radius * cosine, height, radius * sine)
            })
        };
        let rings = (profile.len() as u32).saturating_sub(1);
        Self {
            vertices: profile.iter().flat_map(ring).collect(),
            triangles: (0..rings).flat_map(|n| band(n * around, around)).collect(),
        }
    }

    /// Returns a closed block from `low` to `high` of twelve triangles.
    pub fn block(low: Vec3, high: Vec3) -> Self {
        let corner = |i: u32| {
            let pick = |axis: u32| if i >> axis & 1 == 0 { low } else { high }[axis as usize];
            Vec3::new(pick(0), pick(1), pick(2))
        };
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        Self::of_quads((0..8).map(corner).collect(), quads)
    }

    /// Appends the vertices and triangles of `other`.
    pub fn joined(mut self, other: &Self) -> Self {
        let shift = self.vertices.len() as u32;
        self.vertices.extend(&other.vertices);
        let triangles = other
            .triangles
            .iter()
            .map(|t| t.map(|vertex| vertex + shift));
        self.triangles.extend(triangles);
        self
    }

    /// Returns the highest point of the mesh over every place of a square grid of `step_mm` that begins at its
    /// corner, as seen from above, mm.
    pub fn seen_from_above(&self, step_mm: f64) -> Vec<Vec3> {
        let (low, high) = self.bounds();
        let count = |length: f64| (length.max(0.0) / step_mm).floor() as usize + 1;
        let (rows, columns) = (count(high.x - low.x), count(high.z - low.z));
        let place = |low: f64, number: usize| low + number as f64 * step_mm;
        let lines = |from: f64, to: f64, low: f64, count: usize| {
            let first = ((from - low) / step_mm).ceil().max(0.0) as usize;
            let end = (((to - low) / step_mm).floor() as usize + 1).min(count);
            first..end.max(first)
        };
        let mut heights = vec![f64::NEG_INFINITY; rows * columns];
        for triangle in 0..self.triangles.len() {
            let corners = self.corners(triangle);
            let (least, most) = bounds(&corners);
            for row in lines(least.x, most.x, low.x, rows) {
                for column in lines(least.z, most.z, low.z, columns) {
                    let at = (place(low.x, row), place(low.z, column));
                    if let Some(above) = height_over(&corners, at) {
                        let height = &mut heights[row * columns + column];
                        *height = height.max(above);
                    }
                }
            }
        }
        let seen = heights.iter().enumerate().filter(|(_, y)| y.is_finite());
        let point = |(at, &y): (usize, &f64)| {
            Vec3::new(place(low.x, at / columns), y, place(low.z, at % columns))
        };
        seen.map(point).collect()
    }
}

/// Returns the triangles between a ring of vertices that starts at `first` and the next one.
fn band(first: u32, around: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..around).flat_map(move |n| {
        let (a, b) = (first + n, first + (n + 1) % around);
        [[a, a + around, b], [b, a + around, b + around]]
    })
}

/// Returns the lowest and highest coordinate of `points` along each axis; of none, infinity and minus infinity.
pub fn bounds<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> (Vec3, Vec3) {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let wider = |(low, high): (Vec3, Vec3), point: &Vec3| (low.inf(point), high.sup(point));
    points.into_iter().fold(none, wider)
}

/// Interpolates vectors at the corners with barycentric coordinates `weights`.
#[inline]
pub(crate) fn weighted(vectors: &[Vec3; 3], weights: [f64; 3]) -> Vec3 {
    vectors[0] * weights[0] + vectors[1] * weights[1] + vectors[2] * weights[2]
}

/// Returns the barycentric coordinates of the point of a triangle closest to `point`.
///
/// By the regions of the triangle, as in Ericson, Real-Time Collision Detection, 5.1.5.
pub(crate) fn closest_point(corners: &[Vec3; 3], point: &Vec3) -> [f64; 3] {
    let [a, b, c] = corners;
    let (ab, ac) = (b - a, c - a);
    let from_a = point - a;
    let (d1, d2) = (ab.dot(&from_a), ac.dot(&from_a));
    // Beyond corner a: both edges lead away from the point.
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let from_b = point - b;
    let (d3, d4) = (ab.dot(&from_b), ac.dot(&from_b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    // The signs of va, vb and vc are the sides of the edges on which the point lies: no root is needed.
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let along = d1 / (d1 - d3);
        return [1.0 - along, along, 0.0];
    }
    let from_c = point - c;
    let (d5, d6) = (ab.dot(&from_c), ac.dot(&from_c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let along = d2 / (d2 - d6);
        return [1.0 - along, 0.0, along];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - along, along];
    }
    // Inside, the areas are the barycentric coordinates.
    let all = va + vb + vc;
    [va / all, vb / all, vc / all]
}

/// Returns the height of a triangle over a place (x, z), if it covers it.
pub(crate) fn height_over([a, b, c]: &[Vec3; 3], (x, z): (f64, f64)) -> Option<f64> {
    let twice_area = |p: &Vec3, q: &Vec3| (p.x - x) * (q.z - z) - (p.z - z) * (q.x - x);
    let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
    let whole: f64 = weights.iter().sum();
    let covers = whole != 0.0 && weights.iter().all(|weight| weight * whole >= 0.0);
    covers.then(|| (weights[0] * a.y + weights[1] * b.y + weights[2] * c.y) / whole)
}

/// Returns the distance along a ray to a triangle, if it hits (Moller & Trumbore 1997).
pub fn hit([a, b, c]: &[Vec3; 3], from: &Vec3, direction: &Vec3) -> Option<f64> {
    // With a small tolerance at the edges, so that no ray passes between two triangles.
    const EDGE: f64 = 1e-9;
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(&ac);
    let determinant = ab.dot(&across);
    if determinant == 0.0 {
        return None;
    }
    let offset = from - a;
    let u = offset.dot(&across) / determinant;
    // Most rays miss, and most of these are rejected here.
    if !(-EDGE..=1.0 + EDGE).contains(&u) {
        return None;
    }
    let turned = offset.cross(&ab);
    let v = direction.dot(&turned) / determinant;
    let distance = ac.dot(&turned) / determinant;
    (v >= -EDGE && u + v <= 1.0 + EDGE && distance > 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_seen_from_above_by_its_top() {
        let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        let seen = block.seen_from_above(1.0);
        assert_eq!(seen.len(), 21 * 31);
        assert!(seen.iter().all(|point| point.y == 8.0));
    }

    #[test]
    fn closest_point_is_no_further_than_any_sample_of_the_triangle() {
        let corners = [[0., 0., 0.], [2., 0.1, 0.], [0.4, 1.5, 0.3]].map(Vec3::from);
        for i in 0..200 {
            let angle = f64::from(i);
            let point = Vec3::new(
                3.0 * angle.sin(),
                3.0 * (1.7 * angle).cos(),
                (0.3 * angle).sin(),
            );
            let best = (weighted(&corners, closest_point(&corners, &point)) - point).norm();
            for a in 0..=20 {
                for b in 0..=(20 - a) {
                    let (u, v) = (f64::from(a) / 20.0, f64::from(b) / 20.0);
                    let there = weighted(&corners, [1.0 - u - v, u, v]);
                    assert!(best <= (there - point).norm() + 1e-12);
                }
            }
        }
    }
}
