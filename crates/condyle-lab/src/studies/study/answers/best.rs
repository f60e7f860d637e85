//! What a search found.

use std::ops::ControlFlow;

use serde::Serialize;

use condyle_io::study::{Design, OUTPUTS};

use super::super::{error::StudyError, plan::Plan, search::search, store::Store};
use super::ranking::within_limits;

/// What a search found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Best {
    /// What was minimised.
    pub minimised: &'static str,
    /// The best test that keeps every limit; none where none does.
    pub row: Option<u64>,
    /// Its inputs, by their keys.
    pub inputs: Vec<(String, f64)>,
    /// Its outputs, by their names.
    pub outputs: Vec<(&'static str, f64)>,
    /// Generations of tests.
    pub generations: u64,
    /// The largest step at the end, as a part of the ranges.
    pub step: f64,
    /// Whether the search closed in on one place.
    pub is_converged: bool,
    /// What was minimised in the best test so far that keeps every limit, generation by generation of tests.
    #[serde(skip)]
    pub progress: Vec<(f64, f64)>,
}

impl Best {
    /// None of a study that is no search.
    pub(super) fn of(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
        let Design::Optimise(keys) = &plan.study().design else {
            return Ok(None);
        };
        let searched = search(plan, &mut |tests| {
            let found: Result<Vec<_>, StudyError> = tests
                .iter()
                .map(|test| store.outputs(test.row, plan))
                .collect();
            let all: Option<Vec<_>> = found?.into_iter().collect();
            Ok(all.map_or(ControlFlow::Break(()), ControlFlow::Continue))
        })?;
        let values = store.column(plan, &keys.minimise)?.values;
        let within = within_limits(plan, store)?;
        let (row, progress) = least(&values, &within);
        let minimised = OUTPUTS.iter().find(|output| output.name == keys.minimise);
        let mut best = Self {
            minimised: minimised.map_or("", |output| output.name),
            row: row.map(|row| row as u64),
            inputs: Vec::new(),
            outputs: Vec::new(),
            generations: searched.generations,
            step: searched.step,
            is_converged: searched.is_converged(),
            progress,
        };
        if let Some(row) = row {
            best.fill(row, plan, store)?;
        }
        Ok(Some(best))
    }

    fn fill(&mut self, row: usize, plan: &Plan, store: &Store) -> Result<(), StudyError> {
        for input in &plan.study().inputs {
            let value = store.column(plan, &input.key)?.values[row];
            self.inputs.push((input.key.clone(), value));
        }
        for output in OUTPUTS {
            let value = store.column(plan, output.name)?.values[row];
            self.outputs.push((output.name, value));
        }
        Ok(())
    }
}

/// The test with the least value that keeps every limit, and how it was come to: (tests, least so far).
fn least(values: &[f64], within: &[bool]) -> (Option<usize>, Vec<(f64, f64)>) {
    let (mut best, mut progress) = (None, Vec::new());
    let allowed = values.iter().zip(within).enumerate();
    for (row, (value, _)) in allowed.filter(|(_, (value, within))| **within && value.is_finite()) {
        if best.is_none_or(|best: usize| *value < values[best]) {
            best = Some(row);
            progress.push(((row + 1) as f64, *value));
        }
    }
    (best, progress)
}
