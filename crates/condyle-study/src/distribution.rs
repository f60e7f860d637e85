//! Values of an input by their places in its distribution.

use condyle_case::{
    config::Level,
    study::{BetaKeys, Input, TriangularKeys, TruncatedKeys, Variation},
};
use statrs::distribution::{Beta, ContinuousCDF, Normal};

use crate::statistics;

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

/// Ends of the range of an unbounded input in designs that need ends, in standard deviations of its normal scores: 95 % of
/// its values lie between.
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
        _ => input.level(value_at_share(input, share)),
    }
}

/// Returns the number of that level, without the rounding of values that files state; NaN for a word.
pub(crate) fn number_at_share(input: &Input, share: f64) -> f64 {
    match &input.variation {
        Variation::Levels(_) => level_at_share(input, share).number().unwrap_or(f64::NAN),
        _ if input.is_whole => value_at_share(input, share).round(),
        _ => value_at_share(input, share),
    }
}

fn value_at_share(input: &Input, share: f64) -> f64 {
    match &input.variation {
        // So that the whole numbers at the ends have the share of the others after rounding.
        Variation::Uniform(keys) if input.is_whole => {
            let value = keys.low - 0.5 + share * (keys.high - keys.low + 1.0);
            value.clamp(keys.low, keys.high)
        }
        other => quantile(other, share),
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
            let ends = match other {
                Variation::Lognormal(_) | Variation::Weibull(_) => {
                    [-END_DEVIATIONS, END_DEVIATIONS].map(normal_share)
                }
                _ => [0.0, 1.0],
            };
            let [low, high] = ends.map(|share| quantile(other, share));
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
        Variation::Lognormal(keys) => {
            let deviations = normal_quantile(share);
            keys.median.unwrap_or_default()
                * (deviations * keys.geometric_standard_deviation.ln()).exp()
        }
        Variation::Weibull(keys) => {
            keys.low + keys.scale * (-(-share).ln_1p()).powf(1.0 / keys.shape)
        }
        Variation::Beta(keys) => beta(keys, share),
        Variation::Empirical(keys) => statistics::quantile(&keys.sorted(), share),
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
    // Far above the mean, shares below a value round to 1; those above it are exact up to 38 deviations, and beyond, the values crowd
    // at the end that is nearer to the mean.
    let sign = if keys.low > mean { -1.0 } else { 1.0 };
    let deviation = sign * keys.standard_deviation;
    let [from, to] = [keys.low, keys.high].map(|end| normal_share((end - mean) / deviation));
    if from == to {
        return mean.clamp(keys.low, keys.high);
    }
    let value = mean + deviation * normal_quantile(from + share * (to - from));
    // Rounding may exceed the ends, and the case may reject such a value.
    value.clamp(keys.low, keys.high)
}

fn beta(keys: &BetaKeys, share: f64) -> f64 {
    let part = Beta::new(keys.alpha, keys.beta).map_or(f64::NAN, |one| one.inverse_cdf(share));
    keys.low + part * (keys.high - keys.low)
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
    use condyle_case::{
        config::Levels,
        study::{EmpiricalKeys, LognormalKeys, NormalKeys, UniformKeys, WeibullKeys},
    };

    #[test]
    fn verify_quantiles_in_closed_form() {
        let lognormal = Variation::Lognormal(LognormalKeys {
            median: Some(2.0),
            geometric_standard_deviation: 3.0,
        });
        let weibull = Variation::Weibull(WeibullKeys {
            low: 1.0,
            scale: 2.0,
            shape: 0.5,
        });
        let beta = Variation::Beta(BetaKeys {
            low: 1.0,
            high: 3.0,
            alpha: 2.0,
            beta: 1.0,
        });
        let values = [4.0, 1.0, 2.0].map(Level::Number).to_vec();
        let empirical = Variation::Empirical(EmpiricalKeys {
            file: None,
            values: Levels(values),
        });
        // One deviation above the median; F = 1 - exp(-sqrt((x - 1) / 2)); F = ((x - 1) / 2)^2; half way from 2 to 4.
        for (variation, share, exact) in [
            (&lognormal, normal_share(1.0), 6.0),
            (&lognormal, 0.5, 2.0),
            (&weibull, 1.0 - (-2.0_f64).exp(), 9.0),
            (&beta, 0.36, 2.2),
            (&beta, 1.0, 3.0),
            (&empirical, 0.75, 3.0),
            (&empirical, 0.0, 1.0),
        ] {
            let found = quantile(variation, share);
            assert!((found - exact).abs() < 1e-8, "{found} {exact}");
        }
    }

    #[test]
    fn unbounded_inputs_have_ends_in_designs_of_points() {
        let keys = WeibullKeys {
            low: 0.0,
            scale: 1.0,
            shape: 2.0,
        };
        let input = Input::new("contact.friction", Variation::Weibull(keys));
        for (part, exact) in [(0.0, 0.151_72), (1.0, 1.945_01)] {
            let Level::Number(found) = level_along(&input, part) else {
                panic!("a distribution has numbers")
            };
            assert!((found - exact).abs() < 1e-4, "{found}");
        }
    }

    #[test]
    fn verify_whole_numbers_have_equal_shares() {
        let keys = UniformKeys {
            low: 1.0,
            high: 4.0,
        };
        let mut input = Input::new("march.updates", Variation::Uniform(keys));
        input.is_whole = true;
        let mut counts = [0; 4];
        for n in 0..1000 {
            let value = number_at_share(&input, (f64::from(n) + 0.5) / 1000.0);
            counts[value as usize - 1] += 1;
        }
        assert_eq!(counts, [250; 4]);
    }

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
        // Nine deviations above the mean, the tail falls off as exp(-9 t): its median is ln(2) / 9 above, by 1.2 %.
        let far = TruncatedKeys {
            low: 19.0,
            high: 200.0,
            ..cut
        };
        let beyond = TruncatedKeys {
            standard_deviation: 0.05,
            ..far.clone()
        };
        assert_eq!(truncated_normal(&beyond, 0.5), beyond.low);
        let median = (truncated_normal(&far, 0.5) - 19.0) / 2.0;
        assert!((median / (2_f64.ln() / 9.0) - 1.0).abs() < 0.02, "{median}");
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
