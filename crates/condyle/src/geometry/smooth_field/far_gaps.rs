//! Bounds on the gap where no triangle is near.

use super::{
    gaps::BEYOND_BAND_MM,
    node_grid::{NodeGrid, SPACING_MM},
};

/// Straight way over way along the grid lines, at least: these are at most sqrt 3 times as long.
const STRAIGHT_PER_PATH: f64 = 0.577;

/// Gives the nodes beyond the band a lower bound of their distance, and says which they are.
///
/// Far inside a closed surface it is negative. An open one has no inside: past its rim, a sign
/// carried round from its back would make the insert overlap it.
pub fn bound_far_gaps(grid: &NodeGrid, gaps: &mut [f64], is_closed: bool) -> Vec<bool> {
    let is_far: Vec<bool> = gaps.iter().map(|&gap| gap == BEYOND_BAND_MM).collect();
    let strides = grid.strides();
    let count = gaps.len();
    let mut pass_on = |there: usize, here: usize| {
        if is_far[here] {
            gaps[here] = nearer(gaps[here], gaps[there], is_closed);
        }
    };
    // One pass carries bounds to higher numbers along all axes at once, the other back to lower ones.
    for here in 0..count {
        let lower = strides.iter().filter(|&&stride| here >= stride);
        lower.for_each(|stride| pass_on(here - stride, here));
    }
    for here in (0..count).rev() {
        let higher = strides.iter().filter(|&&stride| here + stride < count);
        higher.for_each(|stride| pass_on(here + stride, here));
    }
    is_far
}

/// A node's bound, or that from its neighbour's gap if it is nearer.
fn nearer(own: f64, neighbours: f64, is_closed: bool) -> f64 {
    let from_there = neighbours.abs() + SPACING_MM * STRAIGHT_PER_PATH;
    if from_there >= own.abs() {
        return own;
    }
    let sign = if is_closed { neighbours.signum() } else { 1.0 };
    sign * from_there
}
