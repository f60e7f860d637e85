//! Values of an input by where they lie in its distribution.

use condyle_case::{
    config::Level,
    study::{Input, TriangularKeys, TruncatedKeys, Variation},
};
use statrs::distribution::{ContinuousCDF, Normal};

/// Where a test has an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    /// As the case has it.
    AsItIs,
    /// Where this share of its distribution lies below.
    Share(f64),
    /// This part of the way from its low end to its high one.
    Along(f64),
}

/// A design goes so many standard deviations from the mean of a normal input where it needs an end.
const END_DEVIATIONS: f64 = 2.0;

/// The value below which lies this share of all, 0 to 1.
pub(crate) fn at_share(input: &Input, share: f64) -> Level {
    match &input.variation {
        Variation::Levels(keys) => {
            let count = keys.levels.0.len();
            let place = (share * count as f64) as usize;
            keys.levels.0[place.min(count - 1)].clone()
        }
        other => input.level(number_at(other, share)),
    }
}

/// The value this part of the way from one end to the other: 0 is the low end, 1 the high one.
pub(crate) fn along(input: &Input, part: f64) -> Level {
    match &input.variation {
        Variation::Levels(_) => at_share(input, part),
        Variation::Normal(keys) => {
            let deviations = END_DEVIATIONS * (2.0 * part - 1.0);
            input.level(keys.mean.unwrap_or_default() + deviations * keys.standard_deviation)
        }
        other => {
            let [low, high] = [0.0, 1.0].map(|share| number_at(other, share));
            input.level(low + part * (high - low))
        }
    }
}

fn number_at(variation: &Variation, share: f64) -> f64 {
    match variation {
        Variation::Uniform(keys) => keys.low + share * (keys.high - keys.low),
        Variation::Normal(keys) => {
            keys.mean.unwrap_or_default() + keys.standard_deviation * deviations(share)
        }
        Variation::TruncatedNormal(keys) => truncated(keys, share),
        Variation::Triangular(keys) => triangular(keys, share),
        Variation::Levels(_) => f64::NAN,
    }
}

/// How many standard deviations off a value is below which lies this share.
pub(crate) fn deviations(share: f64) -> f64 {
    Normal::standard().inverse_cdf(share)
}

/// The share that lies below so many standard deviations.
pub(crate) fn share_below(deviations: f64) -> f64 {
    Normal::standard().cdf(deviations)
}

fn truncated(keys: &TruncatedKeys, share: f64) -> f64 {
    let mean = keys.mean.unwrap_or_default();
    let below = |value: f64| share_below((value - mean) / keys.standard_deviation);
    let (least, most) = (below(keys.low), below(keys.high));
    let value = mean + keys.standard_deviation * deviations(least + share * (most - least));
    value.clamp(keys.low, keys.high)
}

/// Of a triangle with its top at the mode: F = (x - low)^2 / ((high - low) (mode - low)) below it, and so from above.
fn triangular(keys: &TriangularKeys, share: f64) -> f64 {
    let (low, high) = (keys.low, keys.high);
    let mode = keys.mode.unwrap_or(f64::midpoint(low, high));
    let (width, rise) = (high - low, mode - low);
    if share * width < rise {
        low + (share * width * rise).sqrt()
    } else {
        high - ((1.0 - share) * width * (high - mode)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_case::study::{NormalKeys, UniformKeys};

    #[test]
    fn verify_medians_and_ends() {
        let triangle = TriangularKeys {
            low: 0.0,
            mode: Some(1.0),
            high: 4.0,
        };
        assert_eq!(triangular(&triangle, 0.0), 0.0);
        assert_eq!(triangular(&triangle, 1.0), 4.0);
        assert!((triangular(&triangle, 0.25) - 1.0).abs() < 1e-12);
        let cut = TruncatedKeys {
            mean: Some(1.0),
            standard_deviation: 2.0,
            low: 0.0,
            high: 2.0,
        };
        assert!((truncated(&cut, 0.5) - 1.0).abs() < 1e-12);
        assert_eq!((truncated(&cut, 0.0), truncated(&cut, 1.0)), (0.0, 2.0));
        let normal = Variation::Normal(NormalKeys {
            mean: Some(3.0),
            standard_deviation: 2.0,
        });
        // 97.5 % of a normal distribution lie below 1.96 standard deviations.
        assert!((number_at(&normal, 0.975) - (3.0 + 2.0 * 1.959_963_985)).abs() < 1e-8);
        let uniform = Variation::Uniform(UniformKeys {
            low: 2.0,
            high: 4.0,
        });
        assert_eq!(number_at(&uniform, 0.25), 2.5);
    }
}
