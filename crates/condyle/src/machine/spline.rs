//! The periodic cubic spline through knots.

use super::{Knot, knot::span_percent};

/// Second derivatives at the knots of the periodic cubic spline.
///
/// The system is cyclic, diagonally dominant and small; Gauss-Seidel contracts by at least a
/// half a sweep, so it is solved to round-off in a few dozen sweeps.
pub(super) fn spline_bends(knots: &[Knot]) -> Vec<f64> {
    let n = knots.len();
    let mut bends = vec![0.0; n];
    if n < 3 {
        return bends;
    }
    let slope = |a: usize| (knots[(a + 1) % n].value - knots[a].value) / span_percent(knots, a);
    for _ in 0..100 {
        for i in 0..n {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            let (left, right) = (span_percent(knots, before), span_percent(knots, i));
            let load = 6.0 * (slope(i) - slope(before));
            bends[i] =
                (load - left * bends[before] - right * bends[after]) / (2.0 * (left + right));
        }
    }
    bends
}

/// A spline piece from its end values and its end bends (second derivative times span^2 / 6).
pub(super) fn cubic(ya: f64, yb: f64, bend_a: f64, bend_b: f64, along: f64) -> (f64, f64) {
    let (u, v) = (along, 1.0 - along);
    let value = v * ya + u * yb + (v * v * v - v) * bend_a + (u * u * u - u) * bend_b;
    let slope = yb - ya - (3.0 * v * v - 1.0) * bend_a + (3.0 * u * u - 1.0) * bend_b;
    (value, slope)
}
