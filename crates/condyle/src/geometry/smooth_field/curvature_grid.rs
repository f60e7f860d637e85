//! Bounds on the curvature of a field around any point near its surface.

use std::{ops::Range, sync::Arc};

use serde::{Deserialize, Serialize};

use super::spline::GapSpline;
use crate::{
    Vec3, Vector,
    geometry::surface_sample::CurvatureBounds,
    number::{F64x4, LANES, Number},
};

/// Gaps of a surface in or near contact, mm.
const NEAR_MM: Range<f64> = -0.6..2.0;

const _: () = assert!(
    CurvatureBounds::KNOWN_GAP_MM < NEAR_MM.end,
    "a point that near lies in a cell that has bounds"
);

/// Half the diagonal of a cell with a margin, in units of its edge: sqrt(3)/2 = 0.866.
const HALF_DIAGONAL: f64 = 0.9;

/// Number of cells around one within which its bounds hold.
const CELLS_AROUND: usize = 1;

/// Bounds on the curvature in every cell of a field's grid near the surface and in the cells around it:
/// the extremes of eight samples per cell.
///
/// A cell lies around a node of the grid. Deeper than contact reaches, a counterface has an
/// inside with its own edges, whose curvature does not matter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvatureGrid {
    /// One per cell, most of them unknown: a dense array takes one memory access.
    cells: Arc<[CellBounds]>,
    /// Distance from any point of a cell within which its bounds hold, mm.
    radius_mm: f64,
}

/// Bounds on the second derivatives of a field, 1/mm, rounded away from zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct CellBounds {
    max_curvature_per_mm: f32,
    concavity_per_mm: f32,
}

impl CellBounds {
    /// A cell away from the surface.
    const UNKNOWN: Self = Self {
        max_curvature_per_mm: -1.0,
        concavity_per_mm: 0.0,
    };

    /// The bounds of an empty set of points.
    const NONE: Self = Self {
        max_curvature_per_mm: 0.0,
        concavity_per_mm: 0.0,
    };

    fn joined(self, other: Self) -> Self {
        Self {
            max_curvature_per_mm: self.max_curvature_per_mm.max(other.max_curvature_per_mm),
            concavity_per_mm: self.concavity_per_mm.max(other.concavity_per_mm),
        }
    }

    /// Creates the bounds at one point, from the field's slope and curvature K there.
    fn at(slope: f64, [xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Self {
        let trace = xx + yy + zz;
        let square = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
        // No eigenvalue of a symmetric matrix is larger than its Frobenius norm, sqrt(K:K). From
        // their mean, tr K/3, the three differ by numbers whose sum is 0 and whose squares have the
        // sum q = K:K - tr^2/3. One lies farthest below the mean where the other two are equal:
        // sqrt(2 q/3) below.
        let deviation2 = (square - trace * trace / 3.0).max(0.0);
        let lowest = trace / 3.0 - (deviation2 * 2.0 / 3.0).sqrt();
        Self {
            max_curvature_per_mm: rounded_up(square.sqrt()),
            // K is the Hessian of the gap over its slope.
            concavity_per_mm: rounded_up((-lowest).max(0.0) * slope),
        }
    }
}

// A bound in single precision must not round towards zero.
fn rounded_up(value: f64) -> f32 {
    (value as f32).next_up()
}

impl CurvatureGrid {
    pub fn new(gap: &GapSpline) -> Self {
        let margin_mm = HALF_DIAGONAL * gap.grid.spacing_mm;
        let near = NEAR_MM.start - margin_mm..NEAR_MM.end + margin_mm;
        let mut cells = vec![CellBounds::UNKNOWN; gap.grid.node_count()];
        let mut known = Vec::new();
        for (node, middle) in gap.grid.inner_nodes() {
            if near.contains(&gap.gap_mm(&middle)) {
                known.push(node);
                cells[node] = in_cell(gap, &middle);
            }
        }
        // A point anywhere in a cell is within one spacing of the neighbours only, so bounds widen cell by cell.
        for _ in 0..CELLS_AROUND {
            cells = with_neighbours(&cells, &known, gap.grid.strides());
        }
        Self {
            cells: cells.into(),
            radius_mm: CELLS_AROUND as f64 * gap.grid.spacing_mm,
        }
    }

    /// Returns the bounds around any point of the cell around a grid node.
    #[inline]
    pub fn around(&self, node: usize) -> CurvatureBounds {
        let cell = self.cells[node];
        if cell.max_curvature_per_mm < 0.0 {
            return CurvatureBounds::UNKNOWN;
        }
        CurvatureBounds {
            radius_mm: self.radius_mm,
            max_curvature_per_mm: cell.max_curvature_per_mm.into(),
            concavity_per_mm: cell.concavity_per_mm.into(),
            curvature_jump_per_mm: 0.0,
        }
    }
}

/// Returns the bounds of every known cell joined with those of the 26 cells around it.
fn with_neighbours(
    cells: &[CellBounds],
    known: &[usize],
    [sx, sy, sz]: [usize; 3],
) -> Vec<CellBounds> {
    let mut joined = cells.to_vec();
    for &cell in known {
        let mut all = CellBounds::NONE;
        for z in [cell - sz, cell, cell + sz] {
            for y in [z - sy, z, z + sy] {
                for x in [y - sx, y, y + sx] {
                    all = all.joined(cells[x]);
                }
            }
        }
        joined[cell] = all;
    }
    joined
}

/// Returns the bounds at eight points of a cell, without those away from contact.
fn in_cell(gap: &GapSpline, middle: &Vec3) -> CellBounds {
    let mut all = CellBounds::NONE;
    let offset_mm = gap.grid.spacing_mm / 4.0;
    let offset = |is_up: bool| if is_up { offset_mm } else { -offset_mm };
    for is_up in [false, true] {
        let points = Vector::new(
            F64x4::from_lanes(|lane| middle.x + offset(lane & 1 == 0)),
            F64x4::from_lanes(|lane| middle.y + offset(lane & 2 == 0)),
            F64x4::splat(middle.z + offset(is_up)),
        );
        let sample = gap.sample(&points);
        let slopes = sample.gap_gradient.dot(&sample.gap_gradient).sqrt();
        for lane in 0..LANES {
            if NEAR_MM.contains(&sample.gap_mm.lane(lane)) {
                let curvature = sample.curvature.entries().map(|entry| entry.lane(lane));
                all = all.joined(CellBounds::at(slopes.lane(lane), curvature));
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, SymmetricEigen};

    #[test]
    fn cell_bounds_hold_the_eigenvalues() {
        let curvatures = [
            [0.05, 0.0, 0.03, 0.0, 0.0, 0.0],
            [0.05, -0.02, 0.03, 0.01, 0.02, -0.04],
            [-0.01, -0.02, 0.0, 0.005, 0.0, 0.0],
        ];
        for [xx, yy, zz, xy, xz, yz] in curvatures {
            let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            let values = SymmetricEigen::new(matrix).eigenvalues;
            let bounds = CellBounds::at(1.0, [xx, yy, zz, xy, xz, yz]);
            assert!(values.amax() <= bounds.max_curvature_per_mm.into());
            assert!(values.min() >= -f64::from(bounds.concavity_per_mm));
        }
        // Two equal curvatures: the bound is the third, along the normal.
        assert!(CellBounds::at(1.0, [0.05, 0.0, 0.05, 0.0, 0.0, 0.0]).concavity_per_mm < 1e-9);
    }
}
