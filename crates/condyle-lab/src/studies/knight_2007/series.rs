//! Sums over series of numbers.

/// The straight line that fits points best, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// Rise for each unit of x.
    pub(super) slope: f64,
    /// Share of the variance that it explains, R2.
    pub(super) r_squared: f64,
}

/// Least squares through `points`; two or more with different x.
pub(super) fn line_through(points: &[(f64, f64)]) -> Line {
    let count = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|point| point.0), mean(&|point| point.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        points
            .iter()
            .map(|point| of(point.0 - x, point.1 - y))
            .sum()
    };
    let (xx, xy, yy) = (sum(&|u, _| u * u), sum(&|u, v| u * v), sum(&|_, v| v * v));
    Line {
        slope: xy / xx,
        r_squared: xy * xy / (xx * yy),
    }
}

/// Smallest and largest.
pub(super) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// How far `value` lies above `reference`, % of it.
pub(super) fn above_percent(value: f64, reference: f64) -> f64 {
    100.0 * (value / reference - 1.0)
}

/// The value of `values` where `xs` is `x`, to a part in 1e9.
pub(super) fn at(xs: &[f64], values: &[f64], x: f64) -> Option<f64> {
    let close = |known: &f64| (known - x).abs() <= 1e-9 * x.abs();
    Some(values[xs.iter().position(close)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_line_and_r_squared() {
        let exact = line_through(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]);
        assert!((exact.slope - 2.0).abs() < 1e-12 && (exact.r_squared - 1.0).abs() < 1e-12);
        let bent = line_through(&[(0.0, 0.0), (1.0, 0.0), (2.0, 3.0)]);
        assert!((bent.slope - 1.5).abs() < 1e-12 && (bent.r_squared - 0.75).abs() < 1e-12);
    }

    #[test]
    fn values_are_found_at_their_place() {
        assert_eq!(at(&[1e6, 2e6], &[3.0, 4.0], 2e6), Some(4.0));
        assert_eq!(at(&[1e6, 2e6], &[3.0, 4.0], 1.5e6), None);
        assert_eq!(range([2.0, -1.0].into_iter()), (-1.0, 2.0));
    }
}
