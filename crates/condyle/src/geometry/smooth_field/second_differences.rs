//! Second differences over a grid: they make gaps a spline, and a spline its mean over a share.

use super::node_grid::{NodeGrid, SPACING_MM};

/// The coefficients of the quadratic B-spline through the gaps at the nodes, but for fourth
/// differences.
///
/// Along one axis the spline's value at a node is (c_before + 6 c + c_after)/8, which is c and an
/// eighth of its second difference. So c = g less an eighth of the second difference of g, an axis
/// after the other.
pub fn spline_coefficients(grid: &NodeGrid, is_far: &[bool], mut gaps: Vec<f64>) -> Vec<f64> {
    for stride in grid.strides() {
        let before = gaps.clone();
        add_second_differences(&mut gaps, &before, is_far, stride, -1.0 / 8.0);
    }
    gaps
}

/// Adds `spread_mm2` times the Laplacian of a spline: the sum of its second differences over the
/// spacing squared.
pub fn add_laplacian(
    grid: &NodeGrid,
    is_far: &[bool],
    to: &mut [f64],
    from: &[f64],
    spread_mm2: f64,
) {
    let factor = spread_mm2 / (SPACING_MM * SPACING_MM);
    for stride in grid.strides() {
        add_second_differences(to, from, is_far, stride, factor);
    }
}

/// Adds `factor` times the second difference along one axis of `from`, where no node of it is
/// beyond the band.
fn add_second_differences(
    to: &mut [f64],
    from: &[f64],
    is_far: &[bool],
    stride: usize,
    factor: f64,
) {
    for i in stride..is_far.len() - stride {
        let (before, after) = (i - stride, i + stride);
        if !(is_far[before] || is_far[i] || is_far[after]) {
            to[i] += factor * (from[before] - 2.0 * from[i] + from[after]);
        }
    }
}
