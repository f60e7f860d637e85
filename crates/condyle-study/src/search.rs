//! A search for the optimum within limits, from generation to generation of tests.

use condyle_case::study::{Bound, Design, OptimiseKeys};
use condyle_results::catalogue;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::{
    distribution::{Place, normal_quantile},
    error::StudyError,
    plan::{Plan, Test, TestResult, output_value},
    random::Random,
};

/// A search ends once its steps are below this part of every range: smaller changes do not change an implant
/// noticeably.
const MIN_STEP: f64 = 1e-3;

/// Returns the results of tests in their order, or none if some of them are missing.
pub(crate) type Evaluate<'a> =
    dyn FnMut(&[Test]) -> Result<Option<Vec<TestResult>>, StudyError> + 'a;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Searched {
    pub generations: u64,
    /// The largest step at the end, as a part of the ranges.
    pub step: f64,
}

impl Searched {
    /// Returns whether the search has converged to one place.
    pub fn is_converged(&self) -> bool {
        self.step < MIN_STEP
    }
}

/// Searches by CMA-ES (Hansen 2016), generation by generation. The tests of a generation depend on the results of the
/// earlier ones and on the seed alone, so that a resumed search repeats its stored tests.
///
/// None for a study that is not a search.
pub(crate) fn search(
    plan: &Plan,
    evaluate: &mut Evaluate<'_>,
) -> Result<Option<Searched>, StudyError> {
    let Design::Optimise(keys) = &plan.study().design else {
        return Ok(None);
    };
    let mut evolution = Evolution::new(plan.study().inputs.len(), keys.seed);
    let size = evolution.rates.size as u64;
    let mut searched = Searched {
        generations: 0,
        step: evolution.largest_step(),
    };
    while !searched.is_converged() && (searched.generations + 1) * size <= keys.size {
        let points = evolution.ask();
        let test = |(row, point): (u64, &Vec<f64>)| {
            let places: Vec<Place> = point.iter().copied().map(Place::Along).collect();
            Test {
                row,
                alternative: 0,
                values: plan.values_at(&places),
            }
        };
        let tests: Vec<Test> = (searched.generations * size..)
            .zip(&points)
            .map(test)
            .collect();
        let Some(found) = evaluate(&tests)? else {
            break;
        };
        let worth = found.iter().map(|found| worth(plan, keys, found));
        evolution.tell(&points, &order(&worth.collect::<Vec<_>>()));
        searched.generations += 1;
        searched.step = evolution.largest_step();
    }
    Ok(Some(searched))
}

/// Returns the places of tests, the best first: those within the limits by the minimised output, then the others by
/// their violation, then those that failed (Deb 2000).
fn order(worth: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..worth.len()).collect();
    order.sort_by(|&one, &other| {
        let (one, other) = (worth[one], worth[other]);
        one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1))
    });
    order
}

/// Returns the relative violation of all limits, and the minimised output.
fn worth(plan: &Plan, keys: &OptimiseKeys, found: &TestResult) -> (f64, f64) {
    let (Ok(outputs), Some(minimised)) = (found, catalogue::output(&keys.minimise)) else {
        return (f64::INFINITY, f64::INFINITY);
    };
    let beyond = |bound: &Bound| {
        // A limit of 0 is no scale; the smallest one avoids a division by zero.
        let scale = bound.most.or(bound.least).unwrap_or(1.0).abs().max(1e-300);
        bound.excess(output_value(&outputs.values, bound.output)) / scale
    };
    let bounds = &plan.study().answers.bounds;
    (
        bounds.iter().map(beyond).sum(),
        output_value(&outputs.values, minimised),
    )
}

/// First step, as a part of the ranges: the ends are less than two steps from the middle.
const FIRST_STEP: f64 = 0.3;
/// Largest step, as a part of the ranges: a longer one would only be mirrored.
const MAX_STEP: f64 = 1.0;
/// Smallest variance: rounding must leave the covariance positive.
const MIN_VARIANCE: f64 = 1e-20;

/// CMA-ES in the unit cube, with the notation and default constants of Hansen (2016). Points beyond the cube are mirrored
/// into it.
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

struct Rates {
    /// Points of a generation.
    size: usize,
    /// Weights of the better half, the best first, with a sum of 1.
    weights: Vec<f64>,
    effective: f64,
    of_path: f64,
    of_step: f64,
    of_one: f64,
    of_many: f64,
    damping: f64,
    /// Expected length of a standard normal vector.
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

    /// Returns the largest standard deviation along an axis, as a part of the ranges.
    pub fn largest_step(&self) -> f64 {
        self.step * self.covariance.diagonal().max().sqrt()
    }

    /// Returns the points of the next generation.
    pub fn ask(&self) -> Vec<Vec<f64>> {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let roots = eigen
            .eigenvalues
            .map(|value| value.max(MIN_VARIANCE).sqrt());
        let stretch = &eigen.eigenvectors * DMatrix::from_diagonal(&roots);
        let mut numbers = Random::stream(self.seed, self.generation);
        let mut point = |_| {
            let normal = DVector::from_fn(self.mean.len(), |_, _| normal_quantile(numbers.share()));
            let point = &self.mean + self.step * (&stretch * normal);
            point.iter().copied().map(mirrored).collect()
        };
        (0..self.rates.size).map(&mut point).collect()
    }

    /// Updates mean, step and covariance from the points of a generation; `order` has their places, the best first.
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
        // The path starts at zero and is shorter at first than in the long run; the power is bounded only for its type.
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
        self.step = (self.step * change).min(MAX_STEP);
    }

    /// Returns C^(-1/2) times a step.
    fn whitened(&self, step: &DVector<f64>) -> DVector<f64> {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let roots = eigen
            .eigenvalues
            .map(|value| 1.0 / value.max(MIN_VARIANCE).sqrt());
        let turn = &eigen.eigenvectors;
        turn * DMatrix::from_diagonal(&roots) * turn.transpose() * step
    }
}

/// Returns a coordinate in 0 to 1, mirrored at the ends.
fn mirrored(value: f64) -> f64 {
    let folded = value.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the mean after a minimisation of (violation, objective).
    fn found(axes: usize, seed: u64, worth: impl Fn(&[f64]) -> (f64, f64)) -> (Vec<f64>, f64) {
        let mut evolution = Evolution::new(axes, seed);
        for _ in 0..150 {
            let points = evolution.ask();
            let all: Vec<(f64, f64)> = points.iter().map(|point| worth(point)).collect();
            evolution.tell(&points, &order(&all));
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
