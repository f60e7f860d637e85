//! Means, medians and bands.

/// The mean of some numbers, zero of none.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / f64::max(count, 1.0)
}

/// The number that as many are above as below, none of none.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// What of a value lies beyond a band about zero in which it tells nothing.
pub(super) fn beyond(value: f64, band: f64) -> f64 {
    value - value.clamp(-band, band)
}
