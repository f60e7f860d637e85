//! The intersections of vertical lines with a surface, and the smooth surface that bridges its holes.

use std::{collections::BTreeMap, ops::RangeInclusive};

use super::grid::ColumnGrid;
use crate::{
    Vec3,
    curved_mesh::{CurvedMesh, Over},
    triangle_mesh::TriangleMesh,
};

/// Edge of the bins that sort the triangles over the transverse plane, mm.
const BIN_MM: f64 = 1.0;
/// A line that slips between two triangles is tried this far beside, mm: much more than numbers
/// are rounded by, and much less than a node's place needs to be known.
const BESIDE_MM: f64 = 1e-4;

/// The vertical lines through a shell, whose triangles are sorted into square bins.
pub struct VerticalLines<'a> {
    curved: CurvedMesh<'a>,
    corner_normals: Vec<[Vec3; 3]>,
    is_closed: bool,
    low: (f64, f64),
    counts: (usize, usize),
    bins: Vec<Vec<u32>>,
}

/// Where a vertical line goes through a shell first and last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Through {
    /// Lowest crossing, mm.
    pub bottom: f64,
    /// Highest crossing, mm.
    pub top: f64,
    /// Cosine of the slope at the highest.
    pub upward: f64,
}

impl<'a> VerticalLines<'a> {
    /// Those through `shell`; a line through a closed one goes in and out.
    pub fn new(shell: &'a TriangleMesh, is_closed: bool) -> Self {
        let (low, high) = shell.bounds();
        let count = |length: f64| (length / BIN_MM) as usize + 1;
        let counts = (count(high.x - low.x), count(high.z - low.z));
        let curved = CurvedMesh::new(shell);
        let mut lines = Self {
            corner_normals: curved.corner_normals(),
            curved,
            is_closed,
            low: (low.x, low.z),
            counts,
            bins: vec![Vec::new(); counts.0 * counts.1],
        };
        for triangle in 0..shell.triangles.len() {
            let [a, b, c] = shell.corners(triangle);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            let (along_x, along_z) = lines.bins_between((low.x, low.z), (high.x, high.z));
            for i in along_x {
                for k in along_z.clone() {
                    lines.bins[i * counts.1 + k].push(triangle as u32);
                }
            }
        }
        lines
    }

    /// Where the line over a place (x, z) goes through the shell, if it does.
    pub fn at(&self, (x, z): (f64, f64)) -> Option<Through> {
        let beside = [
            (x, z),
            (x - BESIDE_MM, z),
            (x + BESIDE_MM, z),
            (x, z - BESIDE_MM),
            (x, z + BESIDE_MM),
        ];
        beside.into_iter().find_map(|place| self.exactly_at(place))
    }

    /// The same without a try beside it.
    pub fn exactly_at(&self, place: (f64, f64)) -> Option<Through> {
        let (i, k) = self.bin_of(place);
        let bin = &self.bins[i * self.counts.1 + k];
        let over = |&triangle: &u32| {
            let triangle = triangle as usize;
            self.curved
                .over(triangle, &self.corner_normals[triangle], place)
        };
        let crossings = bin.iter().filter_map(over);
        let through = crossings.fold(None, |through: Option<Through>, over| {
            Some(through.map_or_else(|| Through::once(over), |all| all.and(over)))
        });
        through.filter(|all| !self.is_closed || all.top > all.bottom)
    }

    /// Numbers along x and z of the bins that cover a rectangle.
    fn bins_between(
        &self,
        low: (f64, f64),
        high: (f64, f64),
    ) -> (RangeInclusive<usize>, RangeInclusive<usize>) {
        let beyond = BESIDE_MM;
        let first = self.bin_of((low.0 - beyond, low.1 - beyond));
        let last = self.bin_of((high.0 + beyond, high.1 + beyond));
        (first.0..=last.0, first.1..=last.1)
    }

    fn bin_of(&self, (x, z): (f64, f64)) -> (usize, usize) {
        let number = |value: f64, low: f64, count: usize| {
            (((value - low) / BIN_MM).floor().max(0.0) as usize).min(count - 1)
        };
        (
            number(x, self.low.0, self.counts.0),
            number(z, self.low.1, self.counts.1),
        )
    }
}

impl Through {
    fn once(over: Over) -> Self {
        Self {
            bottom: over.height,
            top: over.height,
            upward: over.upward,
        }
    }

    fn and(self, over: Over) -> Self {
        let is_higher = over.height > self.top;
        Self {
            bottom: self.bottom.min(over.height),
            top: self.top.max(over.height),
            upward: if is_higher { over.upward } else { self.upward },
        }
    }
}

/// Rounds in which heights settle at the mean of those around, at most.
const ROUNDS: usize = 1000;
/// Heights that are settled in all, about: over a hole as large as an insert, rounds are fewer.
const MAX_SETTLED: usize = 2_000_000;
/// So many times the way to the mean goes a height in a round: fewer rounds do.
const OVER_RELAXED: f64 = 1.8;
/// Heights that move less than this have settled, mm.
const SETTLED_MM: f64 = 1e-6;

/// Heights of backside and top at the samples of holes, and at those beside them.
#[derive(Default)]
pub struct Bridges {
    heights_mm: BTreeMap<usize, [f64; 2]>,
}

impl Bridges {
    /// Spans some samples: every height is the mean of those of the four samples around, where the shell's own `height`
    /// holds for those beside.
    pub fn add(
        &mut self,
        samples: &ColumnGrid,
        spanned: &[usize],
        height: impl Fn(usize) -> Option<[f64; 2]>,
    ) {
        let mut heights = BTreeMap::new();
        for &sample in spanned {
            for other in corners_around(samples, sample) {
                let is_beside = spanned.binary_search(&other).is_err();
                if let Some(own) = is_beside.then(|| height(other)).flatten() {
                    heights.insert(other, own);
                }
            }
        }
        let mean = mean(heights.values());
        heights.extend(spanned.iter().map(|&sample| (sample, mean)));
        for _ in 0..ROUNDS.min(MAX_SETTLED / spanned.len().max(1)) {
            if settle(&mut heights, samples, spanned) < SETTLED_MM {
                break;
            }
        }
        self.heights_mm.extend(heights);
    }

    /// What the vertical line over a place meets, if it is on a bridge.
    pub fn at(&self, samples: &ColumnGrid, (x, z): (f64, f64)) -> Option<Through> {
        let cell = |value: f64, low: f64, step: f64| {
            let cells = (value - low) / step;
            (cells.max(0.0).floor(), cells - cells.max(0.0).floor())
        };
        let (i, along) = cell(x, samples.origin_mm.0, samples.step_mm.0);
        let (k, across) = cell(z, samples.origin_mm.1, samples.step_mm.1);
        let (i, k) = (i as usize, k as usize);
        if i >= samples.cells.0 || k >= samples.cells.1 {
            return None;
        }
        let weights = [
            (1.0 - along) * (1.0 - across),
            (1.0 - along) * across,
            along * across,
            along * (1.0 - across),
        ];
        let corners = samples.corners(i, k).into_iter().zip(weights);
        let mut height = [0.0; 2];
        for (corner, weight) in corners {
            let at = self.heights_mm.get(&corner)?;
            height = [0, 1].map(|end| height[end] + weight * at[end]);
        }
        Some(Through {
            bottom: height[0],
            top: height[1],
            upward: 1.0,
        })
    }
}

/// Moves every spanned height to the mean of those around; gives how far one moves at most, mm.
fn settle(heights: &mut BTreeMap<usize, [f64; 2]>, samples: &ColumnGrid, spanned: &[usize]) -> f64 {
    let mut most: f64 = 0.0;
    for &sample in spanned {
        let around = samples.around(sample);
        let known: Vec<[f64; 2]> = around.filter_map(|n| heights.get(&n).copied()).collect();
        let (mean, before) = (mean(known.iter()), heights[&sample]);
        let here = [0, 1].map(|end| before[end] + OVER_RELAXED * (mean[end] - before[end]));
        heights.insert(sample, here);
        most = most
            .max((here[0] - before[0]).abs())
            .max((here[1] - before[1]).abs());
    }
    most
}

/// The samples at the corners of the four cells around one.
fn corners_around(samples: &ColumnGrid, sample: usize) -> impl Iterator<Item = usize> + use<'_> {
    let along_z = |row: usize| {
        let per_row = samples.cells.1 + 1;
        samples
            .around(row)
            .filter(move |other| other / per_row == row / per_row)
    };
    let rows = samples.around(sample).chain([sample]);
    rows.flat_map(move |row| along_z(row).chain([row]))
}

fn mean<'a>(heights: impl Iterator<Item = &'a [f64; 2]>) -> [f64; 2] {
    let (count, sum) = heights.fold((0.0_f64, [0.0; 2]), |(count, sum), height| {
        (count + 1.0, [sum[0] + height[0], sum[1] + height[1]])
    });
    sum.map(|sum| sum / count.max(1.0))
}
