//! What the tests of a study tell.

mod best;
mod effects;
mod elementary;
mod front;
mod indices;
mod interval;
mod ranking;
mod spread;
mod table;

use serde::Serialize;

use condyle_io::study::{Design, Output};

use super::{
    error::StudyError,
    plan::Plan,
    store::{Column, Store},
};

pub use best::Best;
pub use effects::Effect;
pub use elementary::Elementary;
pub use front::Front;
pub use indices::Indices;
pub use ranking::{Designed, Ranking};
pub use spread::{Beyond, Spread};

/// What the tests of a study tell; `answers.json` has all of it.
#[derive(Clone, Debug, Serialize)]
pub struct Answers {
    /// Of the study.
    pub title: String,
    /// How tests were chosen.
    pub design: &'static str,
    /// Tests in all; of a search, at most.
    pub tests: u64,
    /// Tests that are kept.
    pub kept: u64,
    /// Tests that failed, by their reasons.
    pub failed: Vec<FailedTests>,
    /// How each output is distributed.
    pub spreads: Vec<Spread>,
    /// How each output goes with each input.
    pub effects: Vec<Effect>,
    /// Elementary effects of a Morris design.
    pub elementary: Vec<Elementary>,
    /// Sobol's indices of a Saltelli design.
    pub indices: Vec<Indices>,
    /// How the designs compare.
    pub ranking: Option<Ranking>,
    /// Tests than which none is better in both of two outputs.
    pub front: Option<Front>,
    /// What a search found.
    pub best: Option<Best>,
}

/// Tests that failed for one reason.
#[derive(Clone, Debug, Serialize)]
pub struct FailedTests {
    /// What was said.
    pub reason: String,
    /// How many.
    pub tests: u64,
}

/// A column of an input or an output with what it is.
pub(super) struct Named<'a, T> {
    pub of: &'a T,
    pub column: Column,
}

impl Answers {
    /// What the tests in `store` tell.
    pub(super) fn of(plan: &Plan, store: &Store) -> Result<Self, StudyError> {
        let study = plan.study();
        let outputs = outputs(plan, store)?;
        let failed = store.reasons()?.into_iter();
        Ok(Self {
            title: study.title.clone(),
            design: condyle_io::keyed::Variants::word(&study.design),
            tests: plan.tests(),
            kept: store.count()?,
            failed: failed
                .map(|(reason, tests)| FailedTests { reason, tests })
                .collect(),
            spreads: outputs
                .iter()
                .map(|output| Spread::of(plan, output))
                .collect(),
            effects: effects::all(plan, store, &outputs)?,
            elementary: elementary::all(plan, &outputs),
            indices: indices::all(plan, &outputs),
            ranking: Ranking::of(plan, store)?,
            front: Front::of(plan, store)?,
            best: Best::of(plan, store)?,
        })
    }

    /// Tables with their headings, the first row of each its head.
    pub(super) fn tables(&self) -> Vec<(String, Vec<Vec<String>>)> {
        table::all(self)
    }

    /// Tables in Markdown, short enough for a terminal.
    pub fn markdown(&self) -> String {
        table::markdown(self)
    }
}

fn outputs<'a>(plan: &Plan, store: &Store) -> Result<Vec<Named<'a, Output>>, StudyError> {
    let outputs = plan.study().answers.outputs.iter();
    let named = |of: &&'static Output| {
        let column = store.column(plan, of.name)?;
        Ok(Named { of: *of, column })
    };
    outputs.map(named).collect()
}

/// Whether every row of a design is as likely as any other, so that shares of rows are probabilities. Of a Saltelli design
/// the two bases are such rows.
pub(super) fn is_of_sample(plan: &Plan, row: usize) -> bool {
    use super::design::Saltelli;
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

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / (values.len() as f64).max(1.0)
}

/// Of a sample, about its mean; 0 of less than two.
pub(super) fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (values.len() as f64 - 1.0).max(1.0)).sqrt()
}
