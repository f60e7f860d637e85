//! The cubic patch over a triangle, and its division into triangles that are nearly flat.

use crate::{Vec3, triangle_mesh::weighted};

/// Distance from its edge at which a curve is divided, mm: the remaining triangles turn by a few degrees.
const DIVIDED_MM: f64 = 0.01;

/// Length of an edge below which it is not divided, mm: half the spacing of the grid of a field.
const MIN_EDGE_MM: f64 = 0.6;

/// Largest number of divisions that lead to a part: a part of an edge can be curved where the whole, an S, is nearly
/// straight, so that the parts next to it become ever narrower and not shorter.
const MAX_DIVISIONS: u32 = 16;

/// The sides of a triangle, from corner to corner.
const SIDES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// A cubic triangle with normals that vary quadratically (Vlachos et al. 2001).
pub(super) struct Patch {
    corners: [Vec3; 3],
    /// Control points of each side, from its first corner to its second.
    sides: [[Vec3; 2]; 3],
    middle: Vec3,
    normals: [Vec3; 3],
    side_normals: [Vec3; 3],
}

/// A nearly flat part of a patch.
pub(super) struct Part {
    /// Barycentric coordinates of its corners on the triangle.
    pub(super) places: [[f64; 3]; 3],
    pub(super) corners: [Vec3; 3],
    pub(super) normals: [Vec3; 3],
}

impl Patch {
    /// Creates the patch of a triangle with unit normals at its corners, whose sides leave the corners along
    /// `tangents`: at the start and the end of each side, both towards its end.
    pub(super) fn new(corners: [Vec3; 3], normals: [Vec3; 3], tangents: [[Vec3; 2]; 3]) -> Self {
        let side = |n: usize| {
            let [i, j] = SIDES[n];
            let [start, end] = tangents[n];
            [corners[i] + start / 3.0, corners[j] - end / 3.0]
        };
        let sides = [0, 1, 2].map(side);
        let flat = corners.iter().sum::<Vec3>() / 3.0;
        let round = sides.iter().flatten().sum::<Vec3>() / 6.0;
        // The normal in the middle of a side is across its curve; twice that less the mean of its ends is
        // the middle coefficient of a quadratic through it.
        let side_normal = |n: usize| {
            let [i, j] = SIDES[n];
            let [start, end] = sides[n];
            let along = corners[j] - corners[i] + end - start;
            let mean = (normals[i] + normals[j]) / 2.0;
            let turned =
                mean - along * (mean.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE));
            turned.try_normalize(0.0).unwrap_or(mean) * 2.0 - mean
        };
        Self {
            corners,
            sides,
            middle: round + (round - flat) / 2.0,
            normals,
            side_normals: [0, 1, 2].map(side_normal),
        }
    }

    fn point(&self, w: [f64; 3]) -> Vec3 {
        let mut point = weighted(&self.corners, w.map(|w| w * w * w));
        for (n, [i, j]) in SIDES.into_iter().enumerate() {
            let [start, end] = self.sides[n];
            point += (start * w[i] + end * w[j]) * (3.0 * w[i] * w[j]);
        }
        point + self.middle * (6.0 * w[0] * w[1] * w[2])
    }

    fn normal(&self, w: [f64; 3]) -> Vec3 {
        let mut normal = weighted(&self.normals, w.map(|w| w * w));
        for (n, [i, j]) in SIDES.into_iter().enumerate() {
            normal += self.side_normals[n] * (2.0 * w[i] * w[j]);
        }
        normal.try_normalize(0.0).unwrap_or_default()
    }

    /// Appends the parts of the patch to `parts`.
    ///
    /// A side is divided by its own curve only, so that the parts of two triangles agree along their edge.
    pub(super) fn divide(&self, parts: &mut Vec<Part>) {
        let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut left = vec![(whole, 0)];
        while let Some((places, divisions)) = left.pop() {
            let corners = places.map(|place| self.point(place));
            let lengths = SIDES.map(|[i, j]| {
                let long = (corners[j] - corners[i]).norm();
                if self.is_curved(places[i], places[j], long) {
                    long
                } else {
                    0.0
                }
            });
            let longest = (0..3)
                .max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
                .unwrap_or(0);
            if lengths[longest] == 0.0 || divisions == MAX_DIVISIONS {
                let normals = places.map(|place| self.normal(place));
                parts.push(Part {
                    places,
                    corners,
                    normals,
                });
                continue;
            }
            let [i, j] = SIDES[longest];
            let middle = between(places[i], places[j], 0.5);
            let (mut one, mut other) = (places, places);
            one[j] = middle;
            other[i] = middle;
            left.extend([one, other].map(|part| (part, divisions + 1)));
        }
    }

    fn is_curved(&self, from: [f64; 3], to: [f64; 3], long: f64) -> bool {
        let (start, end) = (self.point(from), self.point(to));
        // At the quarters, too: the middle of an S is on its chord.
        let is_far = |part: f64| {
            let flat = start + (end - start) * part;
            (self.point(between(from, to, part)) - flat).norm() > DIVIDED_MM
        };
        long > MIN_EDGE_MM && [0.5, 0.25, 0.75].into_iter().any(is_far)
    }
}

fn between(from: [f64; 3], to: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| from[i] + (to[i] - from[i]) * part)
}
