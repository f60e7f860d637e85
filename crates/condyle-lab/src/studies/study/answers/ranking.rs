//! How designs compare under the same disturbances.

use serde::Serialize;

use super::super::{
    error::StudyError,
    plan::{Plan, designs},
    store::Store,
};
use super::interval::of_share;
use super::moments::{mean, standard_deviation};

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
    pub(super) fn of(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
        let study = plan.study();
        if study.alternatives.is_empty() {
            return Ok(None);
        }
        let output = study.answers.rank_by;
        let values = store.column(plan, output.name)?.values;
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
            output: output.name,
            title: output.title,
            unit: output.unit,
            disturbances: common.len(),
            designs: ranked(tried.collect()),
        }))
    }
}

/// Whether each test keeps every limit.
pub(super) fn within_limits(plan: &Plan, store: &Store) -> Result<Vec<bool>, StudyError> {
    let mut within = vec![true; plan.tests() as usize];
    for bound in &plan.study().answers.bounds {
        let values = store.column(plan, bound.output.name)?.values;
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
}
