//! Statistics of samples.

pub use condyle::machine::extremes as extent;

/// Returns the mean, or 0 for an empty sample.
pub fn mean(values: &[f64]) -> f64 {
    // An empty sum is -0.
    (values.iter().sum::<f64>() + 0.0) / (values.len() as f64).max(1.0)
}

/// Returns the sample standard deviation, or 0 for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (values.len() as f64 - 1.0).max(1.0)).sqrt()
}

/// Returns the quantile of sorted values, linear between neighbours; NaN for an empty sample.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// Returns the interval that holds the central 95 % of the values.
pub fn central_interval(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [0.025, 0.975].map(|share| quantile(&values, share))
}

/// The two-sided 95 % quantile of the standard normal distribution.
pub const NORMAL_95: f64 = 1.959_964;

/// Returns the 95 % interval of a probability, observed `hits` times in `tests` (Wilson 1927); 0 to 1 without tests.
pub fn wilson_interval(hits: f64, tests: f64) -> [f64; 2] {
    if tests == 0.0 {
        return [0.0, 1.0];
    }
    // Unlike the normal interval, it stays within 0 and 1 and does not collapse when all or none of the tests hit.
    let (share, square) = (hits / tests, NORMAL_95 * NORMAL_95);
    let middle = share + square / (2.0 * tests);
    let half = NORMAL_95 * (share * (1.0 - share) / tests + square / (4.0 * tests * tests)).sqrt();
    let whole = 1.0 + square / tests;
    [
        ((middle - half) / whole).max(0.0),
        ((middle + half) / whole).min(1.0),
    ]
}

/// Returns Pearson's correlation; none for fewer than three pairs, or if either variable is constant.
pub fn correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    let (mean_x, mean_y) = (mean(x), mean(y));
    let [mut xy, mut xx, mut yy] = [0.0; 3];
    for (x, y) in x.iter().zip(y) {
        let (x, y) = (x - mean_x, y - mean_y);
        xy += x * y;
        xx += x * x;
        yy += y * y;
    }
    (x.len() > 2 && xx > 0.0 && yy > 0.0).then(|| xy / (xx * yy).sqrt())
}

/// Returns Spearman's rank correlation; none in the same cases as [`correlation`].
pub fn rank_correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let (x, y): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    correlation(&ranks(&x), &ranks(&y))
}

/// Returns the rank of each value; equal values share the mean of their ranks.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&one, &other| values[one].total_cmp(&values[other]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for equal in order.chunk_by(|&one, &other| values[one] == values[other]) {
        let rank = first as f64 + (equal.len() as f64 - 1.0) / 2.0;
        equal.iter().for_each(|&place| ranks[place] = rank);
        first += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_wilson_intervals() {
        // Wilson's of 0 of 10 ends at z^2 / (10 + z^2).
        let [low, high] = wilson_interval(0.0, 10.0);
        assert!(low == 0.0 && (high - 3.8415 / 13.8415).abs() < 1e-4);
        let [low, high] = wilson_interval(50.0, 100.0);
        assert!((low - 0.4038).abs() < 1e-4 && (high - 0.5962).abs() < 1e-4);
        assert_eq!(wilson_interval(0.0, 0.0), [0.0, 1.0]);
    }

    #[test]
    fn verify_quantiles_lie_between_values() {
        let sorted: Vec<f64> = (0..=40).map(f64::from).collect();
        assert_eq!(quantile(&sorted, 0.025), 1.0);
        assert_eq!(quantile(&sorted, 0.975), 39.0);
        assert_eq!(quantile(&[3.0, 5.0], 0.25), 3.5);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn verify_correlations() {
        let x = [1.0, 2.0, 3.0, 4.0];
        let with = |y: &[f64]| correlation(&x, y);
        assert!((with(&[2.0, 4.0, 6.0, 8.0]).unwrap() - 1.0).abs() < 1e-15);
        assert!(with(&[1.0, -1.0, -1.0, 1.0]).unwrap().abs() < 1e-15);
        assert_eq!(with(&[5.0; 4]), None);
        assert_eq!(correlation(&x[..2], &[1.0, 2.0]), None);
    }

    #[test]
    fn verify_ranks_and_their_correlation() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [2.5, 0.0, 2.5, 1.0]);
        let cubes: Vec<(f64, f64)> = (-5..6)
            .map(|x| (f64::from(x), f64::from(x).powi(3)))
            .collect();
        assert!((rank_correlation(&cubes).unwrap() - 1.0).abs() < 1e-12);
        let constant = [(1.0, 2.0), (2.0, 2.0), (3.0, 2.0)];
        assert_eq!(rank_correlation(&constant), None);
    }
}
