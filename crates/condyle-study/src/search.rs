//! A search for the best within limits, from test to test.

use std::ops::ControlFlow;

use condyle_case::study::{Bound, Design, OptimiseKeys};
use condyle_results::catalogue::{self, Scalar};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::{
    chance::Numbers,
    distribution::Place,
    distribution::deviations,
    error::StudyError,
    plan::{Plan, Test, TestResult},
};

/// A search ends where its steps are below this part of every range: less makes no other implant.
const CLOSE: f64 = 1e-3;

/// Gives what tests found, in their order, or a break if somebody asked to stop.
pub(crate) type Evaluate<'a> =
    dyn FnMut(Vec<Test>) -> Result<ControlFlow<(), Vec<TestResult>>, StudyError> + 'a;

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Searched {
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
pub(crate) fn search(plan: &Plan, evaluate: &mut Evaluate<'_>) -> Result<Searched, StudyError> {
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
        let place = catalogue::outputs().position(|output: &Scalar| output.key == name);
        place.map_or(f64::INFINITY, |place| outputs[place])
    };
    let beyond = |bound: &Bound| {
        let scale = bound.most.or(bound.least).unwrap_or(1.0).abs().max(1e-300);
        bound.excess(value(bound.output.key)) / scale
    };
    let bounds = &plan.study().answers.bounds;
    (bounds.iter().map(beyond).sum(), value(&keys.minimise))
}

/// First step, as a part of the ranges: from the middle, the ends are within two.
const FIRST_STEP: f64 = 0.3;
/// Longest step, as a part of the ranges.
const LONGEST_STEP: f64 = 1.0;
/// Least of a variance, so that rounding leaves the matrix positive.
const MIN_VARIANCE: f64 = 1e-20;

/// A normal distribution that moves to where the better ones of its points are (Hansen 2016, with its notation and
/// default constants). Points beyond the cube are mirrored into it.
pub(crate) struct Evolution {
    mean: DVector<f64>,
    step: f64,
    covariance: DMatrix<f64>,
    path_of_step: DVector<f64>,
    path_of_covariance: DVector<f64>,
    generation: u64,
    seed: u64,
    rates: Rates,
}

/// How fast each part learns.
struct Rates {
    size: usize,
    /// Weights of the better half, the best first; their sum is 1.
    weights: Vec<f64>,
    effective: f64,
    of_path: f64,
    of_step: f64,
    of_one: f64,
    of_many: f64,
    damping: f64,
    /// How long a vector of normal numbers is on average.
    length: f64,
}

impl Rates {
    fn new(axes: usize) -> Self {
        let n = axes as f64;
        let size = 4 + (3.0 * n.ln()) as usize;
        let half = size / 2;
        let raw = (1..=half).map(|rank| (half as f64 + 0.5).ln() - (rank as f64).ln());
        let raw: Vec<f64> = raw.collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let of_step = (effective + 2.0) / (n + effective + 5.0);
        let of_one = 2.0 / ((n + 1.3).powi(2) + effective);
        let of_many = 2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0).powi(2) + effective);
        Self {
            size,
            weights,
            effective,
            of_path: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            of_step,
            of_one,
            of_many: of_many.min(1.0 - of_one),
            damping: 1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + of_step,
            length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

impl Evolution {
    pub fn new(axes: usize, seed: u64) -> Self {
        Self {
            mean: DVector::from_element(axes, 0.5),
            step: FIRST_STEP,
            covariance: DMatrix::identity(axes, axes),
            path_of_step: DVector::zeros(axes),
            path_of_covariance: DVector::zeros(axes),
            generation: 0,
            seed,
            rates: Rates::new(axes),
        }
    }

    /// Points of a generation.
    pub fn size(&self) -> usize {
        self.rates.size
    }

    /// The standard deviation along the axis that has the largest, as a part of the ranges.
    pub fn largest_step(&self) -> f64 {
        self.step * self.covariance.diagonal().max().sqrt()
    }

    /// The points of the next generation.
    pub fn ask(&self) -> Vec<Vec<f64>> {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let roots = eigen
            .eigenvalues
            .map(|value| value.max(MIN_VARIANCE).sqrt());
        let stretch = &eigen.eigenvectors * DMatrix::from_diagonal(&roots);
        let mut numbers = Numbers::of_one(self.seed, self.generation);
        let mut point = |_| {
            let normal = DVector::from_fn(self.mean.len(), |_, _| deviations(numbers.share()));
            let point = &self.mean + self.step * (&stretch * normal);
            point.iter().copied().map(mirrored).collect()
        };
        (0..self.rates.size).map(&mut point).collect()
    }

    /// Learns from the points of a generation, whose places `order` has, the best first.
    pub fn tell(&mut self, points: &[Vec<f64>], order: &[usize]) {
        let rates = &self.rates;
        let step =
            |place: &usize| (DVector::from_column_slice(&points[*place]) - &self.mean) / self.step;
        let steps: Vec<DVector<f64>> = order.iter().take(rates.weights.len()).map(step).collect();
        let weighted = || rates.weights.iter().zip(&steps);
        let zero = DVector::zeros(self.mean.len());
        let mean_step = weighted().fold(zero, |sum, (weight, step)| sum + *weight * step);
        let many = weighted().fold(&self.covariance * 0.0, |sum, (weight, step)| {
            sum + *weight * step * step.transpose()
        });
        self.learn(&mean_step, &many);
    }

    fn learn(&mut self, mean_step: &DVector<f64>, many: &DMatrix<f64>) {
        let rates = &self.rates;
        let gain = |rate: f64| (rate * (2.0 - rate) * rates.effective).sqrt();
        self.path_of_step = (1.0 - rates.of_step) * &self.path_of_step
            + gain(rates.of_step) * self.whitened(mean_step);
        self.generation += 1;
        let length = self.path_of_step.norm();
        let forgotten = (1.0 - rates.of_step).powi(2 * self.generation.min(1 << 20) as i32);
        let is_slow = length / (1.0 - forgotten).sqrt()
            < (1.4 + 2.0 / (self.mean.len() as f64 + 1.0)) * rates.length;
        let kept = if is_slow { gain(rates.of_path) } else { 0.0 };
        self.path_of_covariance =
            (1.0 - rates.of_path) * &self.path_of_covariance + kept * mean_step;
        let path = &self.path_of_covariance;
        let lost = if is_slow {
            0.0
        } else {
            rates.of_path * (2.0 - rates.of_path)
        };
        self.mean += self.step * mean_step;
        self.covariance = (1.0 - rates.of_one - rates.of_many + rates.of_one * lost)
            * &self.covariance
            + rates.of_one * path * path.transpose()
            + rates.of_many * many;
        let change = (rates.of_step / rates.damping * (length / rates.length - 1.0)).exp();
        self.step = (self.step * change).min(LONGEST_STEP);
    }

    /// C^(-1/2) of a step.
    fn whitened(&self, step: &DVector<f64>) -> DVector<f64> {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let roots = eigen
            .eigenvalues
            .map(|value| 1.0 / value.max(MIN_VARIANCE).sqrt());
        let turn = &eigen.eigenvectors;
        turn * DMatrix::from_diagonal(&roots) * turn.transpose() * step
    }
}

/// A coordinate in 0 to 1, mirrored at the ends.
fn mirrored(value: f64) -> f64 {
    let folded = value.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean after a search for the least of (what a point is beyond its limit, its worth).
    fn found(axes: usize, seed: u64, worth: impl Fn(&[f64]) -> (f64, f64)) -> (Vec<f64>, f64) {
        let mut evolution = Evolution::new(axes, seed);
        for _ in 0..150 {
            let points = evolution.ask();
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&one, &other| {
                let (one, other) = (worth(&points[one]), worth(&points[other]));
                one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1))
            });
            evolution.tell(&points, &order);
        }
        (
            evolution.mean.iter().copied().collect(),
            evolution.largest_step(),
        )
    }

    #[test]
    fn verify_the_bottom_of_a_turned_valley_is_found() {
        for seed in [1, 2] {
            let (mean, step) = found(3, seed, |x| {
                let (u, v) = (x[0] + x[1] - 0.9, x[0] - x[1] + 0.3);
                (0.0, u * u + 100.0 * v * v + (x[2] - 0.8).powi(2))
            });
            let exact = [0.3, 0.6, 0.8];
            let off = mean.iter().zip(exact).map(|(x, e)| (x - e).abs());
            assert!(
                off.fold(0.0, f64::max) < 1e-3 && step < 1e-3,
                "{mean:?} {step}"
            );
        }
    }

    #[test]
    fn verify_the_best_at_a_limit_and_in_a_corner() {
        // Least of x + y where x y >= 0.25 : x = y = 0.5.
        let (mean, _) = found(2, 1, |x| ((0.25 - x[0] * x[1]).max(0.0), x[0] + x[1]));
        assert!(
            (mean[0] - 0.5).abs() < 0.02 && (mean[1] - 0.5).abs() < 0.02,
            "{mean:?}"
        );
        let (mean, _) = found(2, 1, |x| (0.0, x[0] - x[1]));
        assert!(mean[0] < 0.01 && mean[1] > 0.99, "{mean:?}");
    }

    #[test]
    fn coordinates_are_mirrored() {
        assert_eq!(mirrored(0.25), 0.25);
        assert!((mirrored(1.2) - 0.8).abs() < 1e-12 && (mirrored(-0.2) - 0.2).abs() < 1e-12);
    }
}
