//! Intervals of shares, and places in sorted values.

/// 95 % of a normal distribution lie within so many standard deviations.
const DEVIATIONS: f64 = 1.959_964;

/// The 95 % interval of a probability of which `hits` of `tests` are known (Wilson 1927); all of it where there are none.
pub(super) fn of_share(hits: f64, tests: f64) -> [f64; 2] {
    if tests == 0.0 {
        return [0.0, 1.0];
    }
    let (share, square) = (hits / tests, DEVIATIONS * DEVIATIONS);
    let middle = share + square / (2.0 * tests);
    let half = DEVIATIONS * (share * (1.0 - share) / tests + square / (4.0 * tests * tests)).sqrt();
    let whole = 1.0 + square / tests;
    [
        ((middle - half) / whole).max(0.0),
        ((middle + half) / whole).min(1.0),
    ]
}

/// Below which lies this part of sorted values, straight between two of them; not a number of none.
pub(super) fn quantile(sorted: &[f64], part: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = part * last as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// Between which lie 95 % of values.
pub(super) fn middle(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [0.025, 0.975].map(|part| quantile(&values, part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_intervals_of_shares() {
        // Wilson's of 0 of 10 ends at z^2 / (10 + z^2).
        let [low, high] = of_share(0.0, 10.0);
        assert!(low == 0.0 && (high - 3.8415 / 13.8415).abs() < 1e-4);
        let [low, high] = of_share(50.0, 100.0);
        assert!((low - 0.4038).abs() < 1e-4 && (high - 0.5962).abs() < 1e-4);
        assert_eq!(of_share(0.0, 0.0), [0.0, 1.0]);
    }

    #[test]
    fn verify_quantiles_lie_between_values() {
        assert_eq!(quantile(&[3.0, 5.0], 0.25), 3.5);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
