//! A body seen from its six sides, and its 24 orientations along the axes of a frame.

use crate::{Mat3, Vec3, geometry::TriangleMesh};

/// One of the six directions along the axes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AxisDirection {
    /// 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// True if the direction points along the axis rather than against it.
    pub is_forward: bool,
}

impl AxisDirection {
    const X: Self = Self::along(0);
    const Y: Self = Self::along(1);
    const Z: Self = Self::along(2);
    const ALL: [Self; 6] = [
        Self::X,
        Self::X.reversed(),
        Self::Y,
        Self::Y.reversed(),
        Self::Z,
        Self::Z.reversed(),
    ];

    const fn along(axis: usize) -> Self {
        Self {
            axis,
            is_forward: true,
        }
    }

    pub(super) const fn reversed(self) -> Self {
        Self {
            axis: self.axis,
            is_forward: !self.is_forward,
        }
    }

    fn unit(self) -> Vec3 {
        let sign = if self.is_forward { 1.0 } else { -1.0 };
        Vec3::ith(self.axis, sign)
    }
}

/// The directions of anterior, superior and right of a body in its given frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    pub(super) anterior: AxisDirection,
    pub(super) superior: AxisDirection,
    pub(super) right: AxisDirection,
}

impl Orientation {
    /// x anterior, y superior, z right: the convention of the ISB.
    pub const ISB: Self = Self {
        anterior: AxisDirection::X,
        superior: AxisDirection::Y,
        right: AxisDirection::Z,
    };

    /// Returns the 24 right-handed orientations.
    pub fn all() -> impl Iterator<Item = Self> {
        let pairs = AxisDirection::ALL
            .into_iter()
            .flat_map(|anterior| AxisDirection::ALL.map(|superior| (anterior, superior)));
        pairs
            .filter(|(anterior, superior)| anterior.axis != superior.axis)
            .flat_map(|(anterior, superior)| {
                let right = anterior.unit().cross(&superior.unit());
                let is_right = move |direction: &AxisDirection| direction.unit() == right;
                let right = AxisDirection::ALL.into_iter().find(is_right);
                right.map(|right| Self {
                    anterior,
                    superior,
                    right,
                })
            })
    }

    /// Returns the orientation whose rotation is nearest to a given one.
    pub fn nearest_to(rotation: &Mat3) -> Self {
        // The trace of a rotation is 1 + 2 cos(angle).
        let close = |one: &Self| (one.rotation().transpose() * rotation).trace();
        let nearest = Self::all().max_by(|a, b| close(a).total_cmp(&close(b)));
        nearest.unwrap_or(Self::ISB)
    }

    /// Returns the rotation of a point of the given frame to x anterior, y superior, z right.
    pub fn rotation(&self) -> Mat3 {
        let rows = [self.anterior, self.superior, self.right].map(|axis| axis.unit().transpose());
        Mat3::from_rows(&rows)
    }
}

/// Cells along the longest extent of a body: about 1 mm for a knee.
const CELLS: f64 = 72.0;

/// Lowest and highest point of a body on a line along an axis.
type Span = Option<(f64, f64)>;

/// A body seen along the three axes of its frame, on a grid. Lengths are shares of its longest
/// extent, so that no unit is needed.
///
/// Only the outer points on the lines count, so that the triangulation, its orientation and the inside do not matter.
pub(super) struct Views {
    low: Vec3,
    size: f64,
    cells: [usize; 3],
    /// One grid per axis of view; the other two axes follow in cyclic order, the second runs fastest.
    spans: [Vec<Span>; 3],
}

impl Views {
    /// Creates the views of a mesh; none for a mesh without extent.
    pub(super) fn new(mesh: &TriangleMesh) -> Option<Self> {
        let (low, high) = mesh.bounds();
        let size = (high - low).max();
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        // At least one cell: a flat body still has a view along its thin side.
        let extent = (high - low) / size;
        let cells = [0, 1, 2].map(|axis| (extent[axis] * CELLS).ceil().max(1.0) as usize);
        let spans = [0, 1, 2].map(|axis| vec![None; cells[(axis + 1) % 3] * cells[(axis + 2) % 3]]);
        let mut views = Self {
            low,
            size,
            cells,
            spans,
        };
        for triangle in 0..mesh.triangles.len() {
            let corners = mesh.corners(triangle).map(|corner| (corner - low) / size);
            (0..3).for_each(|axis| views.add(axis, &corners));
        }
        Some(views)
    }

    /// Widens the spans at the middles of those cells that the triangle covers, seen along `axis`.
    fn add(&mut self, axis: usize, corners: &[Vec3; 3]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        // Less a half, so that whole numbers are the middles of cells.
        let [a, b, c] = corners.map(|corner| (corner[u] * CELLS - 0.5, corner[v] * CELLS - 0.5));
        let area = cross(a, b, c);
        if area == 0.0 {
            return;
        }
        let [at_a, at_b, at_c] = corners.map(|corner| corner[axis]);
        for i in between([a.0, b.0, c.0], self.cells[u]) {
            for k in between([a.1, b.1, c.1], self.cells[v]) {
                let place = (i as f64, k as f64);
                let weights = [cross(place, b, c), cross(a, place, c), cross(a, b, place)];
                let [of_a, of_b, of_c] = weights.map(|weight| weight / area);
                if of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0 {
                    let height = of_a * at_a + of_b * at_b + of_c * at_c;
                    let span = &mut self.spans[axis][i * self.cells[v] + k];
                    let (low, high) = span.unwrap_or((height, height));
                    *span = Some((low.min(height), high.max(height)));
                }
            }
        }
    }

    /// Returns the position along an axis, mm, at a number of cells from the low end.
    pub(super) fn place(&self, axis: usize, cells: f64) -> f64 {
        self.low[axis] + cells / CELLS * self.size
    }

    pub(super) fn cells(&self, direction: AxisDirection) -> f64 {
        self.cells[direction.axis] as f64
    }

    /// Returns the view against `toward`: rows along `rows`, columns along `columns`.
    pub(super) fn picture(
        &self,
        toward: AxisDirection,
        rows: AxisDirection,
        columns: AxisDirection,
    ) -> Picture {
        let spans = &self.spans[toward.axis];
        let (row_count, column_count) = (self.cells[rows.axis], self.cells[columns.axis]);
        let rows_run_fastest = (toward.axis + 2) % 3 == rows.axis;
        let height = |row: usize, column: usize| {
            let (row, column) = (
                place(rows, row, row_count),
                place(columns, column, column_count),
            );
            let cell = if rows_run_fastest {
                column * row_count + row
            } else {
                row * column_count + column
            };
            let highest = |(low, high): (f64, f64)| if toward.is_forward { high } else { -low };
            spans[cell].map(highest)
        };
        let heights =
            (0..row_count).flat_map(|row| (0..column_count).map(move |column| (row, column)));
        Picture {
            rows: row_count,
            columns: column_count,
            heights: heights.map(|(row, column)| height(row, column)).collect(),
        }
    }
}

/// Returns the number along the axis of cell `at` in a direction.
fn place(direction: AxisDirection, at: usize, count: usize) -> usize {
    if direction.is_forward {
        at
    } else {
        count - 1 - at
    }
}

/// Returns twice the area of a triangle, with its sign.
fn cross(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> f64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// Returns the whole numbers below `count` that lie between the smallest and the largest of three.
fn between(ends: [f64; 3], count: usize) -> std::ops::Range<usize> {
    let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let last = (high.floor() + 1.0).max(0.0) as usize;
    low.ceil().max(0.0) as usize..last.min(count)
}

/// A body seen from one side: the height of each cell towards the viewer.
pub(super) struct Picture {
    pub rows: usize,
    pub columns: usize,
    heights: Vec<Option<f64>>,
}

impl Picture {
    pub(super) fn height(&self, row: usize, column: usize) -> Option<f64> {
        self.heights[row * self.columns + column]
    }

    /// Heights in a row from one share of the width to another.
    pub(super) fn across(&self, row: usize, from: f64, to: f64) -> impl Iterator<Item = f64> {
        part(self.columns, from, to).filter_map(move |column| self.height(row, column))
    }

    /// Heights in a column from one share of the length to another.
    pub(super) fn along(&self, column: usize, from: f64, to: f64) -> impl Iterator<Item = f64> {
        part(self.rows, from, to).filter_map(move |row| self.height(row, column))
    }

    /// Returns the share of the cells without a match in the mirror image, left for right, within `off`.
    pub(super) fn asymmetry(&self, off: f64) -> f64 {
        let (mut seen, mut unmatched) = (0.0, 0.0);
        for row in 0..self.rows {
            for column in 0..self.columns {
                let Some(height) = self.height(row, column) else {
                    continue;
                };
                seen += 1.0;
                let mirrored = self.height(row, self.columns - 1 - column);
                if mirrored.is_none_or(|mirrored| (mirrored - height).abs() > off) {
                    unmatched += 1.0;
                }
            }
        }
        unmatched / f64::max(seen, 1.0)
    }

    /// Returns the share of the picture's area that water would fill in rain along the columns: cells above the
    /// silhouette and below parts of it on both sides.
    pub(super) fn water(&self) -> f64 {
        let tops: Vec<usize> = (0..self.columns).map(|column| self.top(column)).collect();
        let highest = |tops: &[usize]| tops.iter().copied().max().unwrap_or(0);
        let depth = |column: usize| {
            let level = highest(&tops[..=column]).min(highest(&tops[column..]));
            level - tops[column]
        };
        let filled: usize = (0..self.columns).map(depth).sum();
        filled as f64 / (self.rows * self.columns) as f64
    }

    /// One past the last row that is seen in a column.
    pub(super) fn top(&self, column: usize) -> usize {
        let seen = |row: &usize| self.height(*row, column).is_some();
        (0..self.rows).rev().find(seen).map_or(0, |row| row + 1)
    }
}

/// Returns the numbers below `count` from one share of it to another.
pub(super) fn part(count: usize, from: f64, to: f64) -> std::ops::Range<usize> {
    let at = |share: f64| (share * count as f64).round() as usize;
    at(from)..at(to).max(at(from) + 1).min(count)
}

/// Returns the mean, or zero if there are no values.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / f64::max(count, 1.0)
}

/// Returns the median, or none if there are no values.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// Returns the part of a value beyond a band about zero.
pub(super) fn beyond(value: f64, band: f64) -> f64 {
    value - value.clamp(-band, band)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_all_24_are_rotations_and_differ() {
        let all: Vec<Orientation> = Orientation::all().collect();
        assert_eq!(all.len(), 24);
        for (i, one) in all.iter().enumerate() {
            assert_eq!(one.rotation().determinant(), 1.0);
            assert!(all[..i].iter().all(|other| other != one));
        }
        assert_eq!(Orientation::ISB.rotation(), Mat3::identity());
    }
}
