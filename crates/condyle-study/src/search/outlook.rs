//! An output of a design under all disturbances, from an emulator over both.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{Beta, ContinuousCDF};

use crate::emulator::{Emulator, Prediction};

/// Predicts the mean or a percentile of an output under disturbances; without disturbances, the output itself.
///
/// Both are sums of the outputs under K disturbances with weights by their ranks: 1 / K each, or those of Harrell and Davis
/// (1982). Such a sum of a Gaussian process is normal, and its correlation with a test is a product of one along the chosen
/// inputs and a sum along the disturbances (Williams, Santner and Notz 2000).
#[derive(Clone)]
pub(super) struct Outlook {
    pub emulator: Emulator,
    disturbances: Vec<Vec<f64>>,
    /// Correlations of the disturbances with those of the tests, a row for each disturbance.
    with_tests: DMatrix<f64>,
    /// Correlations of the disturbances with each other.
    among: DMatrix<f64>,
    /// The weight of each rank.
    weights: DVector<f64>,
}

impl Outlook {
    /// Creates the outlook on the output of `emulator`, whose last axes are those of the disturbances: on the mean, or on the
    /// percentile above `share` of the disturbances.
    pub fn new(emulator: Emulator, disturbances: &[Vec<f64>], share: Option<f64>) -> Self {
        // A search without disturbances judges a design by one test without any.
        let disturbances = if disturbances.is_empty() {
            vec![Vec::new()]
        } else {
            disturbances.to_vec()
        };
        let count = disturbances.len();
        let weights = match share {
            Some(share) if count > 1 => percentile_weights(count, share),
            _ => DVector::from_element(count, 1.0 / count as f64),
        };
        Self::with(emulator, disturbances, weights)
    }

    fn with(emulator: Emulator, disturbances: Vec<Vec<f64>>, weights: DVector<f64>) -> Self {
        let axes = || emulator.axes() - disturbances[0].len()..emulator.axes();
        let rows = disturbances.iter();
        let rows = rows.map(|one| emulator.with_tests(axes(), one).transpose());
        let with_tests = DMatrix::from_rows(&rows.collect::<Vec<_>>());
        let count = disturbances.len();
        let among = DMatrix::from_fn(count, count, |row, column| {
            emulator.correlation(axes(), &disturbances[row], &disturbances[column])
        });
        Self {
            with_tests,
            among,
            emulator,
            disturbances,
            weights,
        }
    }

    /// Returns the outlook after a test with the result that the emulator predicts.
    pub fn believing(&self, point: &[f64]) -> Option<Self> {
        let mean = self.emulator.mean(point);
        let emulator = self.emulator.with_test(point.to_vec(), mean)?;
        let (disturbances, weights) = (self.disturbances.clone(), self.weights.clone());
        Some(Self::with(emulator, disturbances, weights))
    }

    /// Predicts the statistic of a design.
    pub fn predict(&self, design: &[f64]) -> Prediction {
        let (with, among) = self.correlations(design);
        self.emulator.predict_average(&with, among)
    }

    /// Returns the slopes of the mean and the standard deviation of the statistic along the axes of a design.
    pub fn slopes(&self, design: &[f64]) -> [DVector<f64>; 2] {
        // The weights are those of ranks, and constant where no two outputs change places.
        let (with, among) = self.correlations(design);
        self.emulator.slopes(design, &with, among)
    }

    /// Returns the mean correlations of the outputs of a design with the tests, and among each other.
    fn correlations(&self, design: &[f64]) -> (DVector<f64>, f64) {
        let near = self.emulator.with_tests(0..design.len(), design);
        let weights = self.weights_at(&near);
        let with = self.with_tests.tr_mul(&weights).component_mul(&near);
        (with, weights.dot(&(&self.among * &weights)))
    }

    /// Returns the weight of each disturbance for a design with these correlations with the tests.
    fn weights_at(&self, near: &DVector<f64>) -> DVector<f64> {
        let count = self.weights.len();
        // Those of a mean. The first and the last of a percentile may be equal, since both may underflow.
        if self.weights.min() == self.weights.max() {
            return self.weights.clone();
        }
        let outputs = &self.with_tests * self.emulator.contributions(near);
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&one, &other| outputs[one].total_cmp(&outputs[other]));
        let mut weights = DVector::zeros(count);
        for (rank, &place) in order.iter().enumerate() {
            weights[place] = self.weights[rank];
        }
        weights
    }

    /// Predicts the output of a design under each disturbance.
    pub fn outputs(&self, design: &[f64]) -> Vec<f64> {
        let under = self.disturbances.iter();
        let output = |one: &Vec<f64>| self.emulator.mean(&[design, one].concat());
        under.map(output).collect()
    }

    /// Returns, for each disturbance, the part of the variance of the statistic of a design that a test under it would
    /// remove: the squared correlation of both.
    pub fn gains(&self, design: &[f64]) -> DVector<f64> {
        let near = self.emulator.with_tests(0..design.len(), design);
        let weights = self.weights_at(&near);
        let with = self.with_tests.tr_mul(&weights).component_mul(&near);
        let statistic = self.emulator.whitened(&with);
        let among = &self.among * &weights;
        let emulator = &self.emulator;
        let own = emulator.covariance([&statistic, &statistic], weights.dot(&among));
        DVector::from_fn(weights.len(), |place, _| {
            let with = self.with_tests.row(place).transpose().component_mul(&near);
            let test = emulator.whitened(&with);
            let both = emulator.covariance([&statistic, &test], among[place]);
            let variance = emulator.covariance([&test, &test], 1.0) + emulator.nugget();
            both * both / (own * variance).max(f64::MIN_POSITIVE)
        })
    }
}

/// Returns the weights of the sorted values of a sample in the estimate of the value above a share of the distribution:
/// I(i / n) - I((i - 1) / n), with the distribution function I of beta(p (n + 1), (1 - p) (n + 1)) (Harrell and Davis 1982).
pub(super) fn percentile_weights(count: usize, share: f64) -> DVector<f64> {
    let shapes = [share, 1.0 - share].map(|part| part * (count as f64 + 1.0));
    let beta = Beta::new(shapes[0], shapes[1]);
    let below = |rank: usize| {
        let part = rank as f64 / count as f64;
        beta.as_ref().map_or(part, |beta| beta.cdf(part))
    };
    DVector::from_fn(count, |rank, _| below(rank + 1) - below(rank))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With many disturbances, the weights of both ends of the ranks are zero.
    #[test]
    fn verify_percentiles_under_many_disturbances() {
        let places =
            (0..40).map(|test| [0.618, 0.414].map(|turn| (f64::from(test) * turn).fract()));
        let points: Vec<Vec<f64>> = places.map(|place| place.to_vec()).collect();
        let of = |point: &[f64]| point[0] + 2.0 * point[1] * point[1];
        let values: Vec<f64> = points.iter().map(|point| of(point)).collect();
        let emulator = Emulator::fit(&points, &values).unwrap();
        let part = |number: usize| (number as f64 + 0.5) / 256.0;
        let disturbances: Vec<Vec<f64>> = (0..256).map(|number| vec![part(number)]).collect();
        for share in [0.5, 0.9, 0.95] {
            let outlook = Outlook::new(emulator.clone(), &disturbances, Some(share));
            let found = outlook.predict(&[0.3]).mean;
            let exact = of(&[0.3, share]);
            assert!((found - exact).abs() < 0.01, "{share}: {found} {exact}");
        }
    }

    #[test]
    fn verify_percentiles_of_a_sample() {
        // The middles of a hundred slices of (0, 1).
        let values = DVector::from_fn(100, |rank, _| (rank as f64 + 0.5) / 100.0);
        for share in [0.5, 0.9, 0.95] {
            let weights = percentile_weights(100, share);
            assert!((weights.sum() - 1.0).abs() < 1e-12);
            let found = weights.dot(&values);
            assert!((found - share).abs() < 5e-3, "{found} {share}");
        }
    }
}
