//! How an output is distributed.

use condyle_case::study::{Bound, Design};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{design::Saltelli, plan::Plan, store::Column};

/// A column of an input or an output with what it is.
pub(crate) struct Named<'a, T> {
    pub of: &'a T,
    pub column: Column,
}

/// Percentiles that are told.
pub const PERCENTILES: [f64; 7] = [2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5];

/// How an output is distributed, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The output.
    pub output: &'static str,
    /// What it is called.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Tests that are told of.
    pub tests: usize,
    /// Whether the tests are a sample of what may happen, so that shares of them are probabilities.
    pub is_sample: bool,
    /// Least.
    pub least: f64,
    /// Most.
    pub most: f64,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub standard_deviation: f64,
    /// 2.5, 5, 25, 50, 75, 95 and 97.5 % of the tests lie below.
    pub percentiles: [f64; 7],
    /// How often it is beyond a limit.
    pub beyond: Vec<Beyond>,
    /// All values, smallest first.
    #[serde(skip)]
    pub sorted: Vec<f64>,
}

/// How often an output is beyond a limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Beyond {
    /// Least that is allowed.
    pub least: Option<f64>,
    /// Most that is allowed.
    pub most: Option<f64>,
    /// Part of the tests.
    pub share: f64,
    /// Its 95 % interval, if the tests are a sample.
    pub interval: [f64; 2],
}

impl Spread {
    pub(crate) fn of(plan: &Plan, output: &Named<'_, Scalar>) -> Self {
        let all = || output.column.values.iter().enumerate();
        let of_sample =
            all().filter(|(row, _)| is_of_sample(plan, row / crate::plan::designs(plan.study())));
        let mut sorted: Vec<f64> = of_sample.map(|(_, value)| *value).collect();
        let is_sample = !sorted.is_empty();
        if !is_sample {
            sorted = all().map(|(_, value)| *value).collect();
        }
        sorted.retain(|value| value.is_finite());
        sorted.sort_by(f64::total_cmp);
        let bounds = plan.study().answers.bounds.iter();
        let own = bounds.filter(|bound| bound.output.key == output.of.key);
        Self {
            output: output.of.key,
            title: output.of.label,
            unit: output.of.unit(),
            tests: sorted.len(),
            is_sample,
            least: quantile(&sorted, 0.0),
            most: quantile(&sorted, 1.0),
            mean: mean(&sorted),
            standard_deviation: standard_deviation(&sorted),
            percentiles: PERCENTILES.map(|percent| quantile(&sorted, percent / 100.0)),
            beyond: own.map(|bound| Beyond::of(bound, &sorted)).collect(),
            sorted,
        }
    }
}

impl Beyond {
    fn of(bound: &Bound, values: &[f64]) -> Self {
        let hits = values
            .iter()
            .filter(|value| bound.excess(**value) > 0.0)
            .count() as f64;
        let tests = values.len() as f64;
        Self {
            least: bound.least,
            most: bound.most,
            share: hits / tests.max(1.0),
            interval: of_share(hits, tests),
        }
    }
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / (values.len() as f64).max(1.0)
}

/// Of a sample, about its mean; 0 of less than two.
pub(crate) fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (values.len() as f64 - 1.0).max(1.0)).sqrt()
}

/// Whether every row of a design is as likely as any other, so that shares of rows are probabilities. Of a Saltelli design
/// the two bases are such rows.
pub(crate) fn is_of_sample(plan: &Plan, row: usize) -> bool {
    let study = plan.study();
    match &study.design {
        Design::LatinHypercube(_) | Design::Sobol(_) | Design::Rows(_) => true,
        Design::Saltelli(_) => !matches!(
            Saltelli::of(row as u64, study.inputs.len()).1,
            Saltelli::Changed(_)
        ),
        Design::Morris(_)
        | Design::FullFactorial(_)
        | Design::OneAtATime(_)
        | Design::Optimise(_) => false,
    }
}

/// 95 % of a normal distribution lie within so many standard deviations.
const DEVIATIONS: f64 = 1.959_964;

/// The 95 % interval of a probability of which `hits` of `tests` are known (Wilson 1927); all of it where there are none.
pub(crate) fn of_share(hits: f64, tests: f64) -> [f64; 2] {
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
pub(crate) fn quantile(sorted: &[f64], part: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = part * last as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// Between which lie 95 % of values.
pub(crate) fn middle(mut values: Vec<f64>) -> [f64; 2] {
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
