//! How an output is distributed.

use serde::Serialize;

use condyle_io::study::{Bound, Output};

use super::super::plan::Plan;
use super::interval::{of_share, quantile};
use super::moments::{mean, standard_deviation};
use super::named::Named;
use super::sample::is_of_sample;

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
    pub(super) fn of(plan: &Plan, output: &Named<'_, Output>) -> Self {
        let all = || output.column.values.iter().enumerate();
        let of_sample = all()
            .filter(|(row, _)| is_of_sample(plan, row / super::super::plan::designs(plan.study())));
        let mut sorted: Vec<f64> = of_sample.map(|(_, value)| *value).collect();
        let is_sample = !sorted.is_empty();
        if !is_sample {
            sorted = all().map(|(_, value)| *value).collect();
        }
        sorted.retain(|value| value.is_finite());
        sorted.sort_by(f64::total_cmp);
        let bounds = plan.study().answers.bounds.iter();
        let own = bounds.filter(|bound| bound.output.name == output.of.name);
        Self {
            output: output.of.name,
            title: output.of.title,
            unit: output.of.unit,
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
