//! How designs compare under the same disturbances.

use std::ops::ControlFlow;

use condyle_case::study::Design;
use condyle_results::catalogue::{self, Scalar};
use serde::Serialize;

use crate::{
    answers::spread::{mean, of_share, standard_deviation},
    error::StudyError,
    plan::{Plan, designs},
    search::search,
    store::Store,
};

/// How designs compare, each tried under the same disturbances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranking {
    /// The output that is to be small.
    pub output: &'static str,
    /// What it is called.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Disturbances under which every design was tried.
    pub disturbances: usize,
    /// The designs, the best first.
    pub designs: Vec<Designed>,
}

/// A design among others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Designed {
    /// Its name.
    pub name: String,
    /// Mean of the output.
    pub mean: f64,
    /// Standard deviation of it.
    pub standard_deviation: f64,
    /// Part of the disturbances under which every limit is kept.
    pub within_limits: f64,
    /// Part of them under which no other design is better.
    pub best: f64,
    /// For each design of the list the probability that this one beats it; half for a tie.
    pub beats: Vec<f64>,
    /// The 95 % intervals of these.
    pub beats_intervals: Vec<[f64; 2]>,
}

/// What one design found under every disturbance.
struct Tried {
    name: String,
    values: Vec<f64>,
    within_limits: Vec<bool>,
}

impl Ranking {
    /// None where there are no designs to compare.
    pub(crate) fn of(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
        let study = plan.study();
        if study.alternatives.is_empty() {
            return Ok(None);
        }
        let output = study.answers.rank_by;
        let values = store.column(plan, output.key)?.values;
        let within = within_limits(plan, store)?;
        let count = designs(study);
        let is_common = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let common: Vec<usize> = (0..values.len() / count)
            .filter(|row| is_common(&values[row * count..(row + 1) * count]))
            .collect();
        let tried = study
            .alternatives
            .iter()
            .enumerate()
            .map(|(place, design)| Tried {
                name: design.name.clone(),
                values: common
                    .iter()
                    .map(|row| values[row * count + place])
                    .collect(),
                within_limits: common
                    .iter()
                    .map(|row| within[row * count + place])
                    .collect(),
            });
        Ok(Some(Self {
            output: output.key,
            title: output.label,
            unit: output.unit(),
            disturbances: common.len(),
            designs: ranked(tried.collect()),
        }))
    }
}

/// Whether each test keeps every limit.
pub(crate) fn within_limits(plan: &Plan, store: &Store) -> Result<Vec<bool>, StudyError> {
    let mut within = vec![true; plan.tests() as usize];
    for bound in &plan.study().answers.bounds {
        let values = store.column(plan, bound.output.key)?.values;
        for (within, value) in within.iter_mut().zip(values) {
            *within &= bound.excess(value) == 0.0 && value.is_finite();
        }
    }
    Ok(within)
}

/// The best first: by how often no other is better, then by the mean.
fn ranked(mut tried: Vec<Tried>) -> Vec<Designed> {
    let best = |tried: &[Tried], design: usize| {
        let count = tried[design].values.len();
        let is_best = |row: &usize| {
            let value = tried[design].values[*row];
            tried.iter().all(|other| value <= other.values[*row])
        };
        (0..count).filter(is_best).count() as f64 / count.max(1) as f64
    };
    let mut order: Vec<(f64, f64, usize)> = (0..tried.len())
        .map(|design| (-best(&tried, design), mean(&tried[design].values), design))
        .collect();
    order.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let places: Vec<usize> = order.iter().map(|(_, _, design)| *design).collect();
    let shares: Vec<f64> = order.iter().map(|(share, _, _)| -share).collect();
    let mut by_place: Vec<Option<Tried>> = tried.drain(..).map(Some).collect();
    let sorted: Vec<Tried> = places
        .iter()
        .filter_map(|place| by_place[*place].take())
        .collect();
    (0..sorted.len())
        .map(|design| designed(&sorted, design, shares[design]))
        .collect()
}

fn designed(sorted: &[Tried], design: usize, best: f64) -> Designed {
    let own = &sorted[design];
    let tests = own.values.len() as f64;
    let wins: Vec<f64> = sorted
        .iter()
        .map(|other| wins(&own.values, &other.values))
        .collect();
    let within = own.within_limits.iter().filter(|within| **within).count() as f64;
    Designed {
        name: own.name.clone(),
        mean: mean(&own.values),
        standard_deviation: standard_deviation(&own.values),
        within_limits: within / tests.max(1.0),
        best,
        beats: wins.iter().map(|wins| wins / tests.max(1.0)).collect(),
        beats_intervals: wins.iter().map(|wins| of_share(*wins, tests)).collect(),
    }
}

/// How often one is smaller than the other; half for a tie.
fn wins(one: &[f64], other: &[f64]) -> f64 {
    let win = |(one, other): (&f64, &f64)| match one.total_cmp(other) {
        std::cmp::Ordering::Less => 1.0,
        std::cmp::Ordering::Equal => 0.5,
        std::cmp::Ordering::Greater => 0.0,
    };
    one.iter().zip(other).map(win).sum()
}

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
    pub(crate) fn of(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
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
        let minimised = catalogue::outputs().find(|output| output.key == keys.minimise);
        let mut best = Self {
            minimised: minimised.map_or("", |output| output.key),
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
        for output in catalogue::outputs() {
            let value = store.column(plan, output.key)?.values[row];
            self.outputs.push((output.key, value));
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

/// Tests that keep every limit and than which none is better in both outputs (Pareto 1896).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Front {
    /// The outputs, both to be small.
    pub outputs: [&'static str; 2],
    /// What they are called.
    pub titles: [&'static str; 2],
    /// Their units.
    pub units: [&'static str; 2],
    /// The tests: number and both outputs, by the first output.
    pub tests: Vec<(u64, f64, f64)>,
    /// All tests that keep the limits, for a picture; of many, some.
    #[serde(skip)]
    pub others: Vec<(f64, f64)>,
}

/// Points of a picture at most.
const MAX_POINTS: usize = 1000;

impl Front {
    /// None where the study asks about one output.
    pub(crate) fn of(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
        let Some(outputs) = plan.study().answers.pareto else {
            return Ok(None);
        };
        let within = within_limits(plan, store)?;
        let one = store.column(plan, outputs[0].key)?.values;
        let other = store.column(plan, outputs[1].key)?.values;
        let both = one.into_iter().zip(other).zip(within);
        let tests: Vec<(u64, f64, f64)> = (0..)
            .zip(both)
            .filter(|(_, ((one, other), within))| *within && one.is_finite() && other.is_finite())
            .map(|(row, ((one, other), _))| (row, one, other))
            .collect();
        let every = tests.len().div_ceil(MAX_POINTS).max(1);
        let shown = tests.iter().step_by(every);
        Ok(Some(Self {
            outputs: outputs.map(|output| output.key),
            titles: outputs.map(|output| output.label),
            units: outputs.map(Scalar::unit),
            others: shown.map(|(_, one, other)| (*one, *other)).collect(),
            tests: undominated(tests),
        }))
    }
}

/// By the first output, and of those with the same the best in the other: each better in that than all before.
fn undominated(mut tests: Vec<(u64, f64, f64)>) -> Vec<(u64, f64, f64)> {
    tests.sort_by(|a, b| {
        a.1.total_cmp(&b.1)
            .then(a.2.total_cmp(&b.2))
            .then(a.0.cmp(&b.0))
    });
    let mut least = f64::INFINITY;
    tests.retain(|test| {
        let is_better = test.2 < least;
        least = least.min(test.2);
        is_better
    });
    tests
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_same_disturbances_tell_designs_apart_that_scatter_alone_would_hide() {
        // One is always better by 1 where both scatter by 100.
        let base: Vec<f64> = (0..50).map(|row| f64::from(row * 37 % 101)).collect();
        let tried = |name: &str, add: f64| Tried {
            name: name.to_owned(),
            values: base.iter().map(|value| value + add).collect(),
            within_limits: vec![true; 50],
        };
        let ranked = ranked(vec![tried("worse", 1.0), tried("better", 0.0)]);
        assert_eq!(ranked[0].name, "better");
        assert_eq!(
            (ranked[0].best, ranked[0].beats.as_slice()),
            (1.0, [0.5, 1.0].as_slice())
        );
        assert!(ranked[0].beats_intervals[1][0] > 0.9);
        assert!(ranked[0].standard_deviation > 10.0);
    }

    #[test]
    fn verify_none_is_better_in_both() {
        let tests = vec![
            (0, 2.0, 2.0),
            (1, 1.0, 3.0),
            (2, 3.0, 1.0),
            (3, 3.0, 3.0),
            (4, 2.0, 2.0),
        ];
        let rows: Vec<u64> = undominated(tests).into_iter().map(|test| test.0).collect();
        assert_eq!(rows, [1, 0, 2]);
    }
}
