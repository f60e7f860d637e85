//! Heights over holes, as if the surface around them went on.

use std::collections::BTreeMap;

use super::grid::ColumnGrid;
use super::vertical_lines::Through;

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
