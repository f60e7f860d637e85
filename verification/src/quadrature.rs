//! Integrals to nearly the last digit.

/// Intervals of Simpson's rule.
const INTERVALS: u32 = 4000;

/// Integral of a smooth function from `from` to `to`, by Simpson's rule.
pub(crate) fn integral(from: f64, to: f64, of: impl Fn(f64) -> f64) -> f64 {
    let step = (to - from) / f64::from(INTERVALS);
    let weighted = |i: u32| {
        let weight = match i {
            0 | INTERVALS => 1.0,
            odd if odd % 2 == 1 => 4.0,
            _ => 2.0,
        };
        weight * of(from + f64::from(i) * step)
    };
    (0..=INTERVALS).map(weighted).sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integral_of_a_known_function() {
        let exact = 1.0 - f64::exp(-3.0);
        assert!((integral(0.0, 3.0, |x| (-x).exp()) - exact).abs() < 1e-13);
    }
}
