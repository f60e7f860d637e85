//! Tests than which none is better in both of two outputs.

use serde::Serialize;

use super::super::{error::StudyError, plan::Plan, store::Store};
use super::ranking::within_limits;

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
    pub(super) fn of(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
        let Some(outputs) = plan.study().answers.pareto else {
            return Ok(None);
        };
        let within = within_limits(plan, store)?;
        let one = store.column(plan, outputs[0].name)?.values;
        let other = store.column(plan, outputs[1].name)?.values;
        let both = one.into_iter().zip(other).zip(within);
        let tests: Vec<(u64, f64, f64)> = (0..)
            .zip(both)
            .filter(|(_, ((one, other), within))| *within && one.is_finite() && other.is_finite())
            .map(|(row, ((one, other), _))| (row, one, other))
            .collect();
        let every = tests.len().div_ceil(MAX_POINTS).max(1);
        let shown = tests.iter().step_by(every);
        Ok(Some(Self {
            outputs: outputs.map(|output| output.name),
            titles: outputs.map(|output| output.title),
            units: outputs.map(|output| output.unit),
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
