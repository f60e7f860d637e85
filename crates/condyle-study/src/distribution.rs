//! Values of an input by their places in its distribution.

use condyle_case::{
    config::Level,
    study::{Input, TriangularKeys, TruncatedKeys, Variation},
};
use statrs::distribution::{ContinuousCDF, Normal};

/// The rule by which a test sets an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    /// The value of the case.
    OfCase,
    /// The quantile of its distribution at this probability.
    Share(f64),
    /// The value at this fraction of the range, from its low end.
    Along(f64),
}

/// Ends of the range of a normal input in designs that need ends: 95 % of its values lie between.
const END_DEVIATIONS: f64 = 2.0;

/// Returns the quantile of this share; of levels, each has the same share.
pub(crate) fn level_at_share(input: &Input, share: f64) -> Level {
    match &input.variation {
        Variation::Levels(keys) => {
            let count = keys.levels.0.len();
            // A share of 1 would be the place after the last.
            let place = (share * count as f64) as usize;
            keys.levels.0[place.min(count - 1)].clone()
        }
        other => input.level(quantile(other, share)),
    }
}

/// Returns the value at the fraction `part` of the range, from its low end.
pub(crate) fn level_along(input: &Input, part: f64) -> Level {
    match &input.variation {
        Variation::Levels(_) => level_at_share(input, part),
        Variation::Normal(keys) => {
            let deviations = END_DEVIATIONS * (2.0 * part - 1.0);
            input.level(keys.mean.unwrap_or_default() + deviations * keys.standard_deviation)
        }
        other => {
            let [low, high] = [0.0, 1.0].map(|share| quantile(other, share));
            input.level(low + part * (high - low))
        }
    }
}

fn quantile(variation: &Variation, share: f64) -> f64 {
    match variation {
        Variation::Uniform(keys) => keys.low + share * (keys.high - keys.low),
        Variation::Normal(keys) => {
            keys.mean.unwrap_or_default() + keys.standard_deviation * normal_quantile(share)
        }
        Variation::TruncatedNormal(keys) => truncated_normal(keys, share),
        Variation::Triangular(keys) => triangular(keys, share),
        Variation::Levels(_) => f64::NAN,
    }
}

pub(crate) fn normal_quantile(share: f64) -> f64 {
    Normal::standard().inverse_cdf(share)
}

/// Returns the share of the standard normal distribution below a value.
pub(crate) fn normal_share(deviations: f64) -> f64 {
    Normal::standard().cdf(deviations)
}

fn truncated_normal(keys: &TruncatedKeys, share: f64) -> f64 {
    let mean = keys.mean.unwrap_or_default();
    let below = |value: f64| normal_share((value - mean) / keys.standard_deviation);
    let (least, most) = (below(keys.low), below(keys.high));
    let value = mean + keys.standard_deviation * normal_quantile(least + share * (most - least));
    // Rounding may exceed the ends, and the case may reject such a value.
    value.clamp(keys.low, keys.high)
}

/// Inverts F = (x - low)^2 / ((high - low) (mode - low)) below the mode, and the mirrored formula above it.
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
        assert!((truncated_normal(&cut, 0.5) - 1.0).abs() < 1e-12);
        assert_eq!(
            (truncated_normal(&cut, 0.0), truncated_normal(&cut, 1.0)),
            (0.0, 2.0)
        );
        let normal = Variation::Normal(NormalKeys {
            mean: Some(3.0),
            standard_deviation: 2.0,
        });
        // 97.5 % of a normal distribution lie below 1.96 standard deviations.
        assert!((quantile(&normal, 0.975) - (3.0 + 2.0 * 1.959_963_985)).abs() < 1e-8);
        let uniform = Variation::Uniform(UniformKeys {
            low: 2.0,
            high: 4.0,
        });
        assert_eq!(quantile(&uniform, 0.25), 2.5);
    }
}
