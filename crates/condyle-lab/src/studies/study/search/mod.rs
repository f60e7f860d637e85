//! A search for the best within limits, from test to test.

mod evolution;

use std::ops::ControlFlow;

use condyle_io::study::{Bound, Design, OUTPUTS, OptimiseKeys, Output};

use super::{
    design::Place,
    error::StudyError,
    plan::{Plan, Test},
    test_run::TestResult,
};
use evolution::Evolution;

/// A search ends where its steps are below this part of every range: less makes no other implant.
const CLOSE: f64 = 1e-3;

/// Gives what tests found, in their order, or a break if somebody asked to stop.
pub(super) type Evaluate<'a> =
    dyn FnMut(Vec<Test>) -> Result<ControlFlow<(), Vec<TestResult>>, StudyError> + 'a;

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Searched {
    /// Generations tried.
    pub generations: u64,
    /// Its largest step at the end, as a part of the ranges.
    pub step: f64,
    /// Whether somebody asked to stop.
    pub is_interrupted: bool,
}

impl Searched {
    /// Whether it has closed in on one place.
    pub fn is_converged(&self) -> bool {
        self.step < CLOSE
    }
}

/// Searches by evolution, generation by generation (CMA-ES, Hansen 2016). The tests of a generation follow from what those
/// before it found and from the seed: a search that is gone on with takes the same way.
pub(super) fn search(plan: &Plan, evaluate: &mut Evaluate<'_>) -> Result<Searched, StudyError> {
    let Design::Optimise(keys) = &plan.study().design else {
        return Ok(Searched {
            generations: 0,
            step: 1.0,
            is_interrupted: false,
        });
    };
    let mut evolution = Evolution::new(plan.study().inputs.len(), keys.seed);
    let size = evolution.size() as u64;
    let mut searched = Searched {
        generations: 0,
        step: evolution.largest_step(),
        is_interrupted: false,
    };
    while !searched.is_converged() && (searched.generations + 1) * size <= keys.size {
        let points = evolution.ask();
        let first = searched.generations * size;
        let test = |(place, point): (u64, &Vec<f64>)| test(plan, first + place, point);
        let tests = (0..).zip(&points).map(test).collect();
        let ControlFlow::Continue(found) = evaluate(tests)? else {
            searched.is_interrupted = true;
            break;
        };
        evolution.tell(&points, &order(plan, keys, &found));
        searched.generations += 1;
        searched.step = evolution.largest_step();
    }
    Ok(searched)
}

fn test(plan: &Plan, row: u64, point: &[f64]) -> Test {
    let places: Vec<Place> = point.iter().copied().map(Place::Along).collect();
    Test {
        row,
        alternative: 0,
        values: plan.at(&places),
    }
}

/// Places of tests, the best first: within the limits by what is minimised, then by how far they are beyond, then those
/// that found nothing (Deb 2000).
fn order(plan: &Plan, keys: &OptimiseKeys, found: &[TestResult]) -> Vec<usize> {
    let worth: Vec<(f64, f64)> = found.iter().map(|found| worth(plan, keys, found)).collect();
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|&one, &other| {
        let (one, other) = (worth[one], worth[other]);
        one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1))
    });
    order
}

/// How far a test is beyond all limits, as parts of them, and what is minimised.
fn worth(plan: &Plan, keys: &OptimiseKeys, found: &TestResult) -> (f64, f64) {
    let Ok(outputs) = found else {
        return (f64::INFINITY, f64::INFINITY);
    };
    let value = |name: &str| {
        let place = OUTPUTS
            .iter()
            .position(|output: &Output| output.name == name);
        place.map_or(f64::INFINITY, |place| outputs[place])
    };
    let beyond = |bound: &Bound| {
        let scale = bound.most.or(bound.least).unwrap_or(1.0).abs().max(1e-300);
        bound.excess(value(bound.output.name)) / scale
    };
    let bounds = &plan.study().answers.bounds;
    (bounds.iter().map(beyond).sum(), value(&keys.minimise))
}
