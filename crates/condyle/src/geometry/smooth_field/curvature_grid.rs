//! How a distance field bends around any point near its surface.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{Curvature, CurvatureBounds, SmoothField};
use crate::{
    Vec3, Vector,
    number::{F64x4, LANES, Number},
};

/// Gaps at which a surface touches or nearly does, mm.
const NEAR_MM: Range<f64> = -0.6..2.0;

/// Half the diagonal of a cell and a little, in edges of it.
const HALF_DIAGONAL: f64 = 0.9;

/// How many cells around one are looked at.
const CELLS_AROUND: usize = 1;

/// For every cell of a field's grid that the surface comes near, how it bends there and in the
/// cells around: the extremes of eight samples a cell.
///
/// Deeper than contact goes, a femoral component has an inside with edges of its own; what bends
/// there is not asked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct CurvatureGrid {
    /// Those of every cell, of most of them unknown: one look in memory finds them.
    bends: Vec<Bends>,
    radius_mm: f64,
}

/// Extremes of the bending of a field, 1/mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Bends {
    sharpest: f32,
    hollow: f32,
}

impl Bends {
    /// Where the surface is not near.
    const UNKNOWN: Self = Self {
        sharpest: -1.0,
        hollow: 0.0,
    };

    /// Of nothing.
    const NONE: Self = Self {
        sharpest: 0.0,
        hollow: 0.0,
    };

    fn joined(self, other: Self) -> Self {
        Self {
            sharpest: self.sharpest.max(other.sharpest),
            hollow: self.hollow.max(other.hollow),
        }
    }

    /// At one point, from the field's slope and curvature K there.
    ///
    /// No eigenvalue of a symmetric matrix is larger than its norm, nor smaller than
    /// tr/3 - sqrt(2/3 (K:K - tr^2/3)).
    fn at(slope: f64, [xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Self {
        let trace = xx + yy + zz;
        let square = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
        let spread2 = (square - trace * trace / 3.0).max(0.0);
        let lowest = trace / 3.0 - (spread2 * 2.0 / 3.0).sqrt();
        Self {
            sharpest: rounded_up(square.sqrt()),
            hollow: rounded_up((-lowest).max(0.0) * slope),
        }
    }
}

fn rounded_up(value: f64) -> f32 {
    (value as f32).next_up()
}

impl CurvatureGrid {
    /// The map of a field whose cells lie around the nodes of its grid.
    pub fn new(field: &SmoothField) -> Self {
        let [sx, sy, sz] = field.strides();
        let edge_mm = field.spacing_mm();
        let margin_mm = HALF_DIAGONAL * edge_mm;
        let near = NEAR_MM.start - margin_mm..NEAR_MM.end + margin_mm;
        let mut bends = vec![Bends::UNKNOWN; field.node_count()];
        let mut cells = Vec::new();
        for (node, place) in field.inner_nodes() {
            if near.contains(&field.gap_mm(&place)) {
                cells.push(node);
                bends[node] = in_cell(field, &place, edge_mm);
            }
        }
        for _ in 0..CELLS_AROUND {
            bends = with_cells_beside(&bends, &cells, [sx, sy, sz]);
        }
        Self {
            bends,
            radius_mm: CELLS_AROUND as f64 * edge_mm,
        }
    }

    /// Bounds around any point of the cell around a grid node.
    #[inline]
    pub fn around(&self, node: usize) -> CurvatureBounds {
        let Bends { sharpest, hollow } = self.bends[node];
        if sharpest < 0.0 {
            return CurvatureBounds::UNKNOWN;
        }
        CurvatureBounds {
            radius_mm: self.radius_mm,
            max_curvature_per_mm: sharpest.into(),
            concavity_per_mm: hollow.into(),
            curvature_jump_per_mm: 0.0,
        }
    }
}

/// Every cell's bends joined with those of the 26 cells around it.
fn with_cells_beside(bends: &[Bends], cells: &[usize], [sx, sy, sz]: [usize; 3]) -> Vec<Bends> {
    let mut joined = bends.to_vec();
    for &cell in cells {
        let mut all = Bends::NONE;
        for z in [cell - sz, cell, cell + sz] {
            for y in [z - sy, z, z + sy] {
                for x in [y - sx, y, y + sx] {
                    all = all.joined(bends[x]);
                }
            }
        }
        joined[cell] = all;
    }
    joined
}

/// Extremes at eight points of a cell, those left out where nothing touches.
fn in_cell(field: &SmoothField, middle: &Vec3, edge_mm: f64) -> Bends {
    let mut all = Bends::NONE;
    let quarter = |bit: bool| if bit { edge_mm / 4.0 } else { -edge_mm / 4.0 };
    for half in [false, true] {
        let points = Vector::new(
            F64x4::from_lanes(|lane| middle.x + quarter(lane & 1 == 0)),
            F64x4::from_lanes(|lane| middle.y + quarter(lane & 2 == 0)),
            F64x4::splat(middle.z + quarter(half)),
        );
        let sample = field.sample(&points);
        let slopes = sample.gap_gradient.dot(&sample.gap_gradient).sqrt();
        for lane in 0..LANES {
            if NEAR_MM.contains(&sample.gap_mm.lane(lane)) {
                let curvature = entries(&sample.curvature, lane);
                all = all.joined(Bends::at(slopes.lane(lane), curvature));
            }
        }
    }
    all
}

fn entries(curvature: &Curvature<F64x4>, lane: usize) -> [f64; 6] {
    let Curvature {
        xx,
        yy,
        zz,
        xy,
        xz,
        yz,
    } = curvature;
    [xx, yy, zz, xy, xz, yz].map(|entry| entry.lane(lane))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, SymmetricEigen};

    #[test]
    fn bends_bound_the_eigenvalues() {
        let curvatures = [
            [0.05, 0.0, 0.03, 0.0, 0.0, 0.0],
            [0.05, -0.02, 0.03, 0.01, 0.02, -0.04],
            [-0.01, -0.02, 0.0, 0.005, 0.0, 0.0],
        ];
        for [xx, yy, zz, xy, xz, yz] in curvatures {
            let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            let values = SymmetricEigen::new(matrix).eigenvalues;
            let bends = Bends::at(1.0, [xx, yy, zz, xy, xz, yz]);
            assert!(values.amax() <= bends.sharpest.into());
            assert!(values.min() >= -f64::from(bends.hollow));
        }
        // Two equal curvatures: the bound is the third, along the normal.
        assert!(Bends::at(1.0, [0.05, 0.0, 0.05, 0.0, 0.0, 0.0]).hollow < 1e-9);
    }
}
