//! A measured curve between its points.

use condyle_io::measured::Sample;

/// One gait cycle, percent.
const CYCLE: f64 = 100.0;
/// Two instants nearer than this are one, percent.
const SAME: f64 = 1e-9;

/// The value at an instant: linear between the points around it, through the seam of the cycle
/// where no point stands at both of its ends; none where these are more than `largest_gap` apart.
pub(super) fn value_at(samples: &[Sample], percent: f64, largest_gap: f64) -> Option<f64> {
    if let Some(sample) = samples.iter().find(|s| (s.percent - percent).abs() < SAME) {
        return Some(sample.value);
    }
    let (before, after) = around(samples, percent)?;
    let gap = after.percent - before.percent;
    let share = (percent - before.percent) / gap;
    (gap <= largest_gap + SAME).then_some(before.value + share * (after.value - before.value))
}

/// The points before and after an instant, moved by a cycle where they lie beyond its seam.
fn around(samples: &[Sample], percent: f64) -> Option<(Sample, Sample)> {
    let after = samples.partition_point(|sample| sample.percent < percent);
    let moved = |sample: &Sample, by: f64| Sample {
        percent: sample.percent + by,
        value: sample.value,
    };
    let before = match after {
        0 => moved(samples.last()?, -CYCLE),
        after => samples[after - 1],
    };
    let next = match samples.get(after) {
        Some(sample) => *sample,
        None => moved(samples.first()?, CYCLE),
    };
    (next.percent > before.percent).then_some((before, next))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(points: &[(f64, f64)]) -> Vec<Sample> {
        let sample = |&(percent, value): &(f64, f64)| Sample { percent, value };
        points.iter().map(sample).collect()
    }

    #[test]
    fn verify_between_points_the_value_is_on_the_straight_line() {
        let curve = samples(&[(0.0, 1.0), (4.0, 5.0), (100.0, 1.0)]);
        assert_eq!(value_at(&curve, 1.0, 10.0), Some(2.0));
        assert_eq!(value_at(&curve, 4.0, 10.0), Some(5.0));
    }

    #[test]
    fn verify_the_seam_is_crossed_in_both_directions() {
        let curve = samples(&[(2.0, 3.0), (50.0, 0.0), (98.0, 1.0)]);
        assert_eq!(value_at(&curve, 99.0, 10.0), Some(1.5));
        assert_eq!(value_at(&curve, 100.0, 10.0), Some(2.0));
        assert_eq!(value_at(&curve, 1.0, 10.0), Some(2.5));
    }

    #[test]
    fn nothing_is_made_up_in_a_wide_gap() {
        let curve = samples(&[(0.0, 1.0), (60.0, 1.0)]);
        assert_eq!(value_at(&curve, 30.0, 10.0), None);
        assert_eq!(value_at(&curve, 80.0, 10.0), None);
        assert_eq!(value_at(&curve, 60.0, 10.0), Some(1.0));
        assert_eq!(value_at(&curve, 30.0, 60.0), Some(1.0));
    }
}
