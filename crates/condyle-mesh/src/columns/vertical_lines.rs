//! The intersections of vertical lines with a surface, and the smooth surface that bridges its holes.

use std::collections::BTreeMap;

use super::grid::{ColumnGrid, Place};
use crate::{
    Vec3,
    curved_mesh::{CurvedMesh, Over},
    divided_mesh::flatten_planes,
    triangle_mesh::TriangleMesh,
};

/// Edge of the bins that sort the triangles over the transverse plane, mm.
const BIN_MM: f64 = 0.5;
/// A line that slips between two triangles is tried again this far away, mm: much more than rounding errors, and much
/// less than the accuracy of a node's position.
const ASIDE_MM: f64 = 1e-4;

/// The vertical lines through a surface, whose triangles are sorted into square bins.
pub(super) struct VerticalLines<'a> {
    curved: CurvedMesh<'a>,
    corner_normals: Vec<[Vec3; 3]>,
    pub(super) is_closed: bool,
    low: Place,
    counts: [usize; 2],
    bins: Vec<Vec<u32>>,
}

/// First and last intersection of a vertical line with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Through {
    pub(super) bottom: f64,
    pub(super) top: f64,
    /// Cosine of the slope at the highest.
    pub(super) upward: f64,
    /// Distance of the curved surface from the triangle at the highest, mm.
    pub(super) lift_mm: f64,
}

impl<'a> VerticalLines<'a> {
    /// Sorts the triangles of a surface; a line through a closed surface enters and leaves it.
    pub(super) fn new(shell: &'a TriangleMesh, is_closed: bool) -> Self {
        let (low, high) = shell.bounds();
        let counts = [high.x - low.x, high.z - low.z].map(|length| (length / BIN_MM) as usize + 1);
        let curved = CurvedMesh::new(shell);
        let mut corner_normals = curved.corner_normals();
        flatten_planes(shell, &mut corner_normals);
        let mut lines = Self {
            corner_normals,
            curved,
            is_closed,
            low: Place::new(low.x, low.z),
            counts,
            bins: vec![Vec::new(); counts[0] * counts[1]],
        };
        for triangle in 0..shell.triangles.len() {
            let [a, b, c] = shell.corners(triangle);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            let first = lines.bin_of(Place::new(low.x - ASIDE_MM, low.z - ASIDE_MM));
            let last = lines.bin_of(Place::new(high.x + ASIDE_MM, high.z + ASIDE_MM));
            for i in first[0]..=last[0] {
                for k in first[1]..=last[1] {
                    lines.bins[i * counts[1] + k].push(triangle as u32);
                }
            }
        }
        lines
    }

    /// Returns the intersections of the line over a place, if it meets the surface.
    pub(super) fn at(&self, place: Place) -> Option<Through> {
        let aside = [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
        let tried = aside.map(|aside| place + Place::from(aside) * ASIDE_MM);
        tried.into_iter().find_map(|place| self.exactly_at(place))
    }

    /// Returns the triangles over a place, and the places on them.
    fn over(&self, place: Place) -> impl Iterator<Item = (usize, Over)> {
        let [i, k] = self.bin_of(place);
        let over = move |&triangle: &u32| {
            let triangle = triangle as usize;
            let normals = &self.corner_normals[triangle];
            let over = self.curved.over(triangle, normals, place.into());
            Some(triangle).zip(over)
        };
        self.bins[i * self.counts[1] + k].iter().filter_map(over)
    }

    /// Returns the highest triangle over a place, its area in mm2, and the place on it.
    pub(super) fn highest(&self, place: Place) -> Option<(usize, f64, Over)> {
        let higher =
            |one: &(usize, Over), other: &(usize, Over)| one.1.height.total_cmp(&other.1.height);
        let (triangle, over) = self.over(place).max_by(higher)?;
        let [a, b, c] = self.curved.mesh.corners(triangle);
        Some((triangle, (b - a).cross(&(c - a)).norm() / 2.0, over))
    }

    /// Returns the height of the voids on the line over a place, mm: where it has left all parts of the body, and meets one again below.
    pub(super) fn void_mm(&self, place: Place) -> f64 {
        // Places on an edge belong to both of its triangles.
        const SAME_MM: f64 = 1e-6;
        let faces = self
            .over(place)
            .map(|(_, over)| (over.height, over.upward > 0.0));
        let mut faces: Vec<(f64, bool)> = faces.collect();
        faces.sort_by(|a, b| b.0.total_cmp(&a.0));
        faces.dedup_by(|a, b| a.1 == b.1 && b.0 - a.0 < SAME_MM);
        let (mut parts_entered, mut left_at_mm, mut void_mm) = (0, None, 0.0);
        for (height_mm, is_upper) in faces {
            if is_upper {
                void_mm += left_at_mm
                    .take()
                    .map_or(0.0, |left_mm: f64| left_mm - height_mm);
            }
            parts_entered += if is_upper { 1 } else { -1 };
            if parts_entered == 0 {
                left_at_mm = Some(height_mm);
            }
        }
        void_mm
    }

    /// Returns the same without a second attempt next to the place.
    pub(super) fn exactly_at(&self, place: Place) -> Option<Through> {
        let through = self.over(place).map(|(_, over)| Through {
            bottom: over.height,
            top: over.height,
            upward: over.upward,
            lift_mm: over.lift_mm,
        });
        let through = through.reduce(|all, one| Through {
            bottom: all.bottom.min(one.bottom),
            ..if one.top > all.top { one } else { all }
        });
        // A line that meets a closed surface once only grazes it.
        through.filter(|all| !self.is_closed || all.top > all.bottom)
    }

    fn bin_of(&self, place: Place) -> [usize; 2] {
        let bins = (place - self.low) / BIN_MM;
        [0, 1].map(|axis| (bins[axis].floor().max(0.0) as usize).min(self.counts[axis] - 1))
    }
}

/// Maximum number of rounds in which heights settle at the mean of their neighbours.
const MAX_ROUNDS: usize = 1000;
/// Approximate limit on heights times rounds: a hole as large as an insert gets fewer rounds.
const MAX_SETTLED: usize = 2_000_000;
/// Over-relaxation factor on the motion of a height towards the mean in a round; it reduces the number of rounds.
const OVER_RELAXED: f64 = 1.8;
const SETTLED_MM: f64 = 1e-6;

/// Heights of backside and top at the samples of holes, and at those next to them.
#[derive(Default)]
pub(super) struct Bridges {
    heights_mm: BTreeMap<usize, [f64; 2]>,
}

impl Bridges {
    /// Spans some samples: every height is the mean of those of its four neighbours, and next to the hole the shell's
    /// own `height` holds.
    pub(super) fn add(
        &mut self,
        samples: &ColumnGrid,
        spanned: &[usize],
        height: impl Fn(usize) -> Option<[f64; 2]>,
    ) {
        let per_row = samples.cells.1 + 1;
        let along_z = |row: usize| {
            let around = samples.around(row);
            around.filter(move |other| other / per_row == row / per_row)
        };
        let mut heights = BTreeMap::new();
        for &sample in spanned {
            // The corners of the four cells around it, and more along z.
            for row in samples.around(sample).chain([sample]) {
                for other in along_z(row).chain([row]) {
                    let is_outside = spanned.binary_search(&other).is_err();
                    if let Some(own) = is_outside.then(|| height(other)).flatten() {
                        heights.insert(other, own);
                    }
                }
            }
        }
        let start = mean(heights.values());
        heights.extend(spanned.iter().map(|&sample| (sample, start)));
        for _ in 0..MAX_ROUNDS.min(MAX_SETTLED / spanned.len().max(1)) {
            let mut largest_move: f64 = 0.0;
            for &sample in spanned {
                let around = samples.around(sample);
                let known: Vec<[f64; 2]> =
                    around.filter_map(|n| heights.get(&n).copied()).collect();
                let (mean, before) = (mean(known.iter()), heights[&sample]);
                let here = [0, 1].map(|end| before[end] + OVER_RELAXED * (mean[end] - before[end]));
                for end in [0, 1] {
                    largest_move = largest_move.max((here[end] - before[end]).abs());
                }
                heights.insert(sample, here);
            }
            if largest_move < SETTLED_MM {
                break;
            }
        }
        self.heights_mm.extend(heights);
    }

    /// Returns the intersections of the vertical line over a place with a bridge, if there is one.
    pub(super) fn at(&self, samples: &ColumnGrid, place: Place) -> Option<Through> {
        let cells = (place - samples.origin_mm).component_div(&samples.step_mm);
        let whole = cells.map(|cell| cell.max(0.0).floor());
        let (i, k) = (whole[0] as usize, whole[1] as usize);
        if i >= samples.cells.0 || k >= samples.cells.1 {
            return None;
        }
        let [along, across]: [f64; 2] = (cells - whole).into();
        let weights = [
            (1.0 - along) * (1.0 - across),
            (1.0 - along) * across,
            along * across,
            along * (1.0 - across),
        ];
        let mut height = [0.0; 2];
        for (corner, weight) in samples.corners(i, k).into_iter().zip(weights) {
            let at = self.heights_mm.get(&corner)?;
            height = [0, 1].map(|end| height[end] + weight * at[end]);
        }
        Some(Through {
            bottom: height[0],
            top: height[1],
            upward: 1.0,
            lift_mm: 0.0,
        })
    }
}

fn mean<'a>(heights: impl Iterator<Item = &'a [f64; 2]>) -> [f64; 2] {
    let (count, sum) = heights.fold((0.0_f64, [0.0; 2]), |(count, sum), height| {
        (count + 1.0, [sum[0] + height[0], sum[1] + height[1]])
    });
    sum.map(|sum| sum / count.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_height_of_a_void_is_found_below_the_surface_only() {
        let block = |low: [f64; 3], high: [f64; 3]| TriangleMesh::block(low.into(), high.into());
        let mut void = block([-4.0, 2.0, -4.0], [4.0, 5.0, 4.0]);
        for triangle in &mut void.triangles {
            triangle.swap(0, 1);
        }
        let body = block([-10.0, 0.0, -10.0], [10.0, 8.0, 10.0]).joined(&void);
        // A foot below is apart from the body by a gap, which is a void too, and a block that overlaps the body is not.
        let foot = block([5.0, -3.0, -10.0], [10.0, -1.0, 10.0]);
        let boss = block([-10.0, 6.0, -10.0], [-6.0, 9.0, 10.0]);
        // Two parts inside the body, above each other, leave no void between them.
        let inner = [2.0, 5.0].map(|low| block([7.0, low, 4.0], [9.0, low + 1.0, 8.0]));
        let body = body.joined(&foot).joined(&boss);
        let body = body.joined(&inner[0]).joined(&inner[1]);
        let lines = VerticalLines::new(&body, true);
        for (x_mm, z_mm, void_mm) in [
            (0.0, 0.3, 3.0),
            // On the diagonal of the faces, which belongs to two triangles.
            (0.0, 0.0, 3.0),
            (4.5, 0.3, 0.0),
            (7.5, 0.3, 1.0),
            (7.5, 5.3, 1.0),
            (-8.0, 0.3, 0.0),
        ] {
            let found = lines.void_mm(Place::new(x_mm, z_mm));
            assert!((found - void_mm).abs() < 1e-9, "{x_mm} {z_mm}: {found}");
        }
    }
}
