//! Observed order of convergence and extrapolated results.

use serde::Serialize;

/// Steps whose ratios differ by less than this share are in constant ratio.
const SAME_RATIO: f64 = 1e-6;
/// A lower order than this is noise, and its extrapolation meaningless.
const MIN_ORDER: f64 = 0.4;
/// Results that differ by less than this share are the same: round-off.
const SAME_RESULT: f64 = 1e-12;

/// The exact result as extrapolated from three or more results on finer and finer steps.
///
/// With steps h r^2, h r, h and results f3, f2, f1 the order is
/// p = ln((f3 - f2)/(f2 - f1)) / ln r, and the results tend to f1 + (f1 - f2)/(r^p - 1)
/// [richardson1911, roache1994].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "tendency", rename_all = "snake_case")]
pub(crate) enum Extrapolation {
    /// The differences shrink, so that the results tend to a value.
    Converging {
        /// Observed order: the error is proportional to the step to this power.
        order: f64,
        /// The limit of the results, in their unit.
        extrapolated: f64,
        /// Estimated error of the finest result, % of the limit.
        finest_error_percent: f64,
    },
    /// The differences shrink too slowly for an extrapolation.
    Slow {
        /// Observed order.
        order: f64,
    },
    /// The results do not depend on the step.
    Unchanged,
    /// The differences change sign.
    Oscillating,
    /// The differences do not shrink.
    Diverging,
    /// No three steps are in constant ratio down to the finest.
    NoConstantRatio,
}

/// Extrapolates `results` on `steps`, both from coarse to fine.
///
/// The three that count are the finest and the two at r and r^2 times its step, with the smallest
/// r > 1 for which there are such.
pub(crate) fn extrapolate(steps: &[f64], results: &[f64]) -> Extrapolation {
    match finest_triple(steps) {
        Some((places, ratio)) => of_triple(places.map(|place| results[place]), ratio),
        None => Extrapolation::NoConstantRatio,
    }
}

/// Places of the three steps, coarse to fine, and their ratio.
fn finest_triple(steps: &[f64]) -> Option<([usize; 3], f64)> {
    let fine = steps.len().checked_sub(1)?;
    if steps.iter().any(|step| !step.is_finite() || *step <= 0.0) {
        return None;
    }
    let coarser = (0..fine).rev();
    coarser.into_iter().find_map(|middle| {
        let ratio = steps[middle] / steps[fine];
        let wanted = steps[middle] * ratio;
        let is_wanted = |&place: &usize| (steps[place] / wanted - 1.0).abs() < SAME_RATIO;
        let coarse = (0..middle).rev().find(is_wanted)?;
        Some(([coarse, middle, fine], ratio))
    })
}

fn of_triple([coarse, middle, fine]: [f64; 3], ratio: f64) -> Extrapolation {
    let (first, last) = (middle - coarse, fine - middle);
    // Differences of round-off have random signs and would be taken for oscillation.
    let noise = SAME_RESULT * fine.abs();
    if first.abs() <= noise && last.abs() <= noise {
        return Extrapolation::Unchanged;
    }
    if first * last < 0.0 {
        return Extrapolation::Oscillating;
    }
    if last.abs() >= first.abs() {
        return Extrapolation::Diverging;
    }
    if last.abs() <= noise {
        return Extrapolation::Unchanged;
    }
    let shrinking = first / last;
    let order = shrinking.ln() / ratio.ln();
    if order < MIN_ORDER {
        return Extrapolation::Slow { order };
    }
    let extrapolated = fine + last / (shrinking - 1.0);
    Extrapolation::Converging {
        order,
        extrapolated,
        finest_error_percent: 100.0 * (fine - extrapolated) / extrapolated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Results of order `order` that tend to 2.
    fn sequence(steps: &[f64], order: f64) -> Vec<f64> {
        steps
            .iter()
            .map(|step| 2.0 + 0.3 * step.powf(order))
            .collect()
    }

    #[test]
    fn verify_order_and_limit_of_power_laws() {
        for (steps, order) in [
            (vec![4.0, 2.0, 1.0], 1.0),
            (vec![1.0, 0.5, 0.25, 0.125], 2.0),
            (vec![9.0, 3.0, 1.0], 0.5),
            (vec![0.121, 0.11, 0.1], 4.0),
        ] {
            let found = extrapolate(&steps, &sequence(&steps, order));
            let Extrapolation::Converging {
                order: observed,
                extrapolated,
                finest_error_percent,
            } = found
            else {
                panic!("{found:?}");
            };
            assert!((observed - order).abs() < 1e-9, "{observed} {order}");
            assert!((extrapolated - 2.0).abs() < 1e-12, "{extrapolated}");
            let error = 15.0 * steps.last().unwrap().powf(order);
            assert!((finest_error_percent - error).abs() < 1e-9);
        }
    }

    #[test]
    fn verify_the_finest_three_in_constant_ratio_count() {
        let steps = [1.0, 0.5, 0.2, 0.1, 0.05, 0.025];
        let mut results = sequence(&steps, 2.0);
        results[..3].fill(7.0);
        let found = extrapolate(&steps, &results);
        assert!(
            matches!(found, Extrapolation::Converging { order, .. } if (order - 2.0).abs() < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn verify_an_order_near_zero_is_not_extrapolated() {
        let steps = [4.0, 2.0, 1.0];
        let found = extrapolate(&steps, &sequence(&steps, 0.2));
        assert!(
            matches!(found, Extrapolation::Slow { order } if (order - 0.2).abs() < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn results_that_tend_nowhere_are_said_to() {
        let steps = [4.0, 2.0, 1.0];
        let of = |results: [f64; 3]| extrapolate(&steps, &results);
        assert_eq!(of([1.0, 1.0, 1.0]), Extrapolation::Unchanged);
        assert_eq!(of([1.0, 2.0, 2.0]), Extrapolation::Unchanged);
        assert_eq!(of([1.0, 2.0, 1.5]), Extrapolation::Oscillating);
        assert_eq!(of([1.0, 2.0, 3.0]), Extrapolation::Diverging);
        assert_eq!(of([1.0, 1.0, 2.0]), Extrapolation::Diverging);
    }

    #[test]
    fn without_a_constant_ratio_nothing_is_extrapolated() {
        for steps in [
            &[][..],
            &[1.0],
            &[2.0, 1.0],
            &[4.0, 3.0, 1.0],
            &[4.0, 2.0, -1.0],
        ] {
            let results = vec![1.0; steps.len()];
            assert_eq!(
                extrapolate(steps, &results),
                Extrapolation::NoConstantRatio,
                "{steps:?}"
            );
        }
    }
}
