//! The stored tests in columns, and the distribution of each output.

use condyle_case::study::{Bound, Design};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    design::Saltelli,
    error::StudyError,
    plan::{Plan, designs},
    statistics::{mean, quantile, standard_deviation, wilson_interval},
    store::{Column, Store},
};

/// The table of a study that answers are computed from.
pub(crate) struct Data<'a> {
    pub plan: &'a Plan,
    pub inputs: Vec<Column>,
    /// The outputs of the study, with a value for each test.
    pub outputs: Vec<(&'static Scalar, Vec<f64>)>,
    /// True for each test that is done and within every limit.
    pub within: Vec<bool>,
}

impl<'a> Data<'a> {
    pub fn read(plan: &'a Plan, store: &Store) -> Result<Self, StudyError> {
        let study = plan.study();
        let values = |output: &Scalar| -> Result<Vec<f64>, StudyError> {
            Ok(store.column(plan, output.key)?.values)
        };
        let mut within = vec![true; plan.tests() as usize];
        for bound in &study.answers.bounds {
            for (within, value) in within.iter_mut().zip(values(bound.output)?) {
                *within &= bound.excess(value) == 0.0 && value.is_finite();
            }
        }
        let inputs = study.inputs.iter();
        let inputs = inputs.map(|input| store.column(plan, &input.key));
        let outputs = study.answers.outputs.iter();
        let outputs = outputs.map(|output| values(output).map(|values| (*output, values)));
        Ok(Self {
            plan,
            inputs: inputs.collect::<Result<_, _>>()?,
            outputs: outputs.collect::<Result<_, _>>()?,
            within,
        })
    }
}

const PERCENTILES: [f64; 7] = [2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5];

/// The distribution of an output, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Spread {
    pub output: &'static str,
    pub title: &'static str,
    pub unit: &'static str,
    pub tests: usize,
    /// True if the tests are a random sample, so that shares of them are probabilities.
    pub is_sample: bool,
    pub least: f64,
    pub most: f64,
    pub mean: f64,
    pub standard_deviation: f64,
    pub percentiles: [f64; 7],
    pub beyond: Vec<Beyond>,
    #[serde(skip)]
    pub sorted: Vec<f64>,
}

/// The share of tests beyond a limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Beyond {
    pub least: Option<f64>,
    pub most: Option<f64>,
    pub share: f64,
    /// The 95 % interval of the probability, if the tests are a sample.
    pub interval: [f64; 2],
}

impl Spread {
    pub fn new(plan: &Plan, output: &'static Scalar, values: &[f64]) -> Self {
        let study = plan.study();
        let rows = values.iter().enumerate();
        let sample = rows.filter(|(row, _)| is_sampled(plan, row / designs(study)));
        let mut sorted: Vec<f64> = sample.map(|(_, value)| *value).collect();
        let is_sample = !sorted.is_empty();
        if !is_sample {
            sorted = values.to_vec();
        }
        sorted.retain(|value| value.is_finite());
        sorted.sort_by(f64::total_cmp);
        let bounds = study.answers.bounds.iter();
        let own = bounds.filter(|bound| bound.output.key == output.key);
        Self {
            output: output.key,
            title: output.label,
            unit: output.unit(),
            tests: sorted.len(),
            is_sample,
            least: quantile(&sorted, 0.0),
            most: quantile(&sorted, 1.0),
            mean: mean(&sorted),
            standard_deviation: standard_deviation(&sorted),
            percentiles: PERCENTILES.map(|percent| quantile(&sorted, percent / 100.0)),
            beyond: own.map(|bound| Beyond::new(bound, &sorted)).collect(),
            sorted,
        }
    }
}

impl Beyond {
    fn new(bound: &Bound, values: &[f64]) -> Self {
        let beyond = values.iter().filter(|value| bound.excess(**value) > 0.0);
        let (hits, tests) = (beyond.count() as f64, values.len() as f64);
        Self {
            least: bound.least,
            most: bound.most,
            share: hits / tests.max(1.0),
            interval: wilson_interval(hits, tests),
        }
    }
}

/// Returns whether a row belongs to a random sample. In a Saltelli design the points A and B do; their mixtures
/// depend on them.
pub(crate) fn is_sampled(plan: &Plan, row: usize) -> bool {
    let study = plan.study();
    match &study.design {
        Design::LatinHypercube(_) | Design::Sobol(_) | Design::Rows(_) => true,
        Design::Saltelli(_) => {
            let (_, test) = Saltelli::of(row as u64, study.inputs.len());
            !matches!(test, Saltelli::Changed(_))
        }
        Design::Morris(_)
        | Design::FullFactorial(_)
        | Design::OneAtATime(_)
        | Design::Optimise(_) => false,
    }
}
