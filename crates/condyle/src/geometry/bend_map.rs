//! How a distance field bends around any point near its surface.

use std::ops::Range;

use super::{Curvature, SmoothField};
use crate::{
    Vec3, Vector,
    number::{LANES, Lanes, Number},
};

/// Gaps at which a surface touches or nearly does, mm.
const NEAR_MM: Range<f64> = -0.6..2.0;

/// Half the diagonal of a cell and a little, in edges of it.
const HALF_DIAGONAL: f64 = 0.9;

/// Bounds on the curvature around a point, 1/mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bends {
    /// No curvature is larger.
    pub sharpest_per_mm: f64,
    /// No two curvatures differ by more.
    pub range_per_mm: f64,
}

impl Bends {
    /// Where nothing is known.
    const UNKNOWN: Self = Self {
        sharpest_per_mm: f64::INFINITY,
        range_per_mm: f64::INFINITY,
    };
}

/// For every cell of a field's grid that the surface comes near, how it bends there and in the
/// cells around: the extremes of eight samples a cell.
///
/// Deeper than contact goes, a femoral component has an inside with edges of its own; what bends
/// there is not asked.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BendMap {
    /// Number of each cell in `bends`.
    number: Vec<u32>,
    bends: Vec<Bends>,
}

/// Extremes of xx, yy, zz, xy, xz, yz, 1/mm.
#[derive(Clone, Copy)]
struct Extremes {
    low: [f64; 6],
    high: [f64; 6],
}

impl Extremes {
    const NONE: Self = Self {
        low: [f64::INFINITY; 6],
        high: [f64::NEG_INFINITY; 6],
    };

    fn join(&mut self, other: &Self) {
        for i in 0..6 {
            self.low[i] = self.low[i].min(other.low[i]);
            self.high[i] = self.high[i].max(other.high[i]);
        }
    }

    fn bends(&self) -> Bends {
        // Entries beside the diagonal stand twice in the matrix.
        let norm = |size: &dyn Fn(usize) -> f64| {
            let square = |i: usize| size(i).powi(2) * if i < 3 { 1.0 } else { 2.0 };
            (0..6).map(square).sum::<f64>().sqrt()
        };
        if self.low[0] > self.high[0] {
            return Bends::UNKNOWN;
        }
        Bends {
            sharpest_per_mm: norm(&|i| self.low[i].abs().max(self.high[i].abs())),
            range_per_mm: norm(&|i| self.high[i] - self.low[i]),
        }
    }
}

const NOT_NEAR: u32 = u32::MAX;

impl BendMap {
    /// The map of a field whose cells lie around the nodes of its grid.
    pub fn new(field: &SmoothField) -> Self {
        let [sx, sy, sz] = field.strides();
        let edge_mm = field.spacing_mm();
        let margin_mm = HALF_DIAGONAL * edge_mm;
        let near = NEAR_MM.start - margin_mm..NEAR_MM.end + margin_mm;
        let mut number = vec![NOT_NEAR; field.node_count()];
        let mut extremes = Vec::new();
        for (node, place) in field.inner_nodes() {
            if near.contains(&field.gap_mm(&place)) {
                number[node] = extremes.len() as u32;
                extremes.push(in_cell(field, &place, edge_mm));
            }
        }
        let around = |node: usize| {
            let mut all = Extremes::NONE;
            for z in [node - sz, node, node + sz] {
                for y in [z - sy, z, z + sy] {
                    for x in [y - sx, y, y + sx] {
                        if let Some(other) = extremes.get(number[x] as usize) {
                            all.join(other);
                        }
                    }
                }
            }
            all.bends()
        };
        let cells = (0..number.len()).filter(|&node| number[node] != NOT_NEAR);
        let bends = cells.map(around).collect();
        Self { number, bends }
    }

    /// Bounds in the cell around a grid node and in those beside it.
    #[inline]
    pub fn around(&self, node: usize) -> Bends {
        let number = self.number[node] as usize;
        self.bends.get(number).copied().unwrap_or(Bends::UNKNOWN)
    }
}

/// Extremes of the curvature at eight points of a cell, those left out where nothing touches.
fn in_cell(field: &SmoothField, middle: &Vec3, edge_mm: f64) -> Extremes {
    let mut extremes = Extremes::NONE;
    let quarter = |bit: bool| if bit { edge_mm / 4.0 } else { -edge_mm / 4.0 };
    for half in [false, true] {
        let points = Vector::new(
            Lanes::from_lanes(|lane| middle.x + quarter(lane & 1 == 0)),
            Lanes::from_lanes(|lane| middle.y + quarter(lane & 2 == 0)),
            Lanes::splat(middle.z + quarter(half)),
        );
        let sample = field.sample(&points);
        for lane in 0..LANES {
            if NEAR_MM.contains(&sample.gap_mm.lane(lane)) {
                let here = entries(&sample.curvature, lane);
                extremes.join(&Extremes {
                    low: here,
                    high: here,
                });
            }
        }
    }
    extremes
}

fn entries(curvature: &Curvature<Lanes>, lane: usize) -> [f64; 6] {
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
