//! A Gaussian process as an emulator of an output: fitted to tests, it predicts others with a standard deviation.

mod process;
#[cfg(test)]
pub(crate) mod tests;

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use self::process::{Process, correlation, log_correlation_slope, parameters};
use crate::{
    descent::minimum,
    design::sobol::sobol_shares,
    distribution::normal_quantile,
    random::Random,
    statistics::{mean, standard_deviation},
};

/// Bounds of the correlation lengths, as parts of the ranges: shorter ones join no two tests, and longer ones mean that
/// the output does not depend on the input.
const LENGTHS: [f64; 2] = [0.02, 50.0];
/// Bounds of the nugget, relative to the variance of the process. With the smallest one, rounding still leaves the
/// correlation of 500 tests positive definite.
const NUGGETS: [f64; 2] = [1e-9, 1.0];
/// Starting lengths of the fits, of which the likeliest is kept, and their starting nugget.
const FIRST_LENGTHS: [f64; 2] = [0.5, 3.0];
const FIRST_NUGGET: f64 = 1e-6;
/// Largest number of tests that determine lengths and nugget: the time of a fit grows with the cube of it, and more
/// tests change them little.
const MAX_FITTED: usize = 128;

/// Smallest nugget of many points together, which rounding of the covariance of several hundred close ones needs.
const JOINT_NUGGET: f64 = 1e-7;

/// Points over which interactions are averaged, and their seed, which no study has: at its own tests the emulator is exact.
const SAMPLES: u64 = 512;
const SAMPLES_SEED: u64 = u64::MAX;

/// Groups of tests, each of which is predicted by an emulator fitted to the others.
const FOLDS: usize = 5;
/// Standard deviation of values that are constant but for rounding, relative to that of all.
const CONSTANT: f64 = 1e-9;

/// A Gaussian process with an unknown mean, and the tensor product of Matern 5/2 correlations with a length for each
/// axis and a nugget (Rasmussen and Williams 2006; Roustant, Ginsbourger and Deville 2012).
#[derive(Clone)]
pub(crate) struct Emulator {
    points: Vec<Vec<f64>>,
    values: Vec<f64>,
    /// The logarithms of the length of each axis and of the nugget.
    logarithms: DVector<f64>,
    lengths: Vec<f64>,
    centre: f64,
    scale: f64,
    process: Process,
    /// The sum by which the squares of errors of left-out tests are too small, since lengths and nugget are fitted to these tests as
    /// well (Burman 1989); 0 before calibration.
    optimism: f64,
}

/// The numbers that predict an output without this program: m + sum of w_i c(x, x_i), in the unit of the output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Model {
    lengths: Vec<f64>,
    nugget: f64,
    mean: f64,
    standard_deviation: f64,
    points: Vec<Vec<f64>>,
    weights: Vec<f64>,
}

/// A predicted output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prediction {
    pub mean: f64,
    pub standard_deviation: f64,
}

impl Emulator {
    /// Fits an emulator to tests at `points`, whose coordinates span about 1, by maximum likelihood; none for fewer than
    /// three tests.
    pub fn fit(points: &[Vec<f64>], values: &[f64]) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let axes = points[0].len();
        let fitted = &points[..points.len().min(MAX_FITTED)];
        let (scaled, _) = scaled(values);
        let scaled = scaled.rows(0, fitted.len()).into_owned();
        let deviance = |logarithms: &DVector<f64>| {
            let process = Process::new(fitted, &scaled, logarithms)?;
            let slope = process.slope(fitted, logarithms);
            Some((process.deviance(), slope))
        };
        let all = |length: f64, nugget: f64| {
            let mut all = DVector::from_element(axes + 1, length.ln());
            all[axes] = nugget.ln();
            all
        };
        let [low, high] = [0, 1].map(|end| all(LENGTHS[end], NUGGETS[end]));
        let starts = FIRST_LENGTHS.map(|length| all(length, FIRST_NUGGET));
        let fits = starts.into_iter();
        let fits = fits.filter_map(|start| minimum(&deviance, start, [&low, &high]));
        let (logarithms, _) = fits.min_by(|one, other| one.1.total_cmp(&other.1))?;
        Self::with(points.to_vec(), values.to_vec(), logarithms)
    }

    /// Conditions an emulator on tests, with the logarithms of lengths and nugget.
    fn with(points: Vec<Vec<f64>>, values: Vec<f64>, logarithms: DVector<f64>) -> Option<Self> {
        let (scaled, [centre, scale]) = scaled(&values);
        Some(Self {
            process: Process::new(&points, &scaled, &logarithms)?,
            lengths: parameters(&logarithms).0,
            points,
            values,
            logarithms,
            centre,
            scale,
            optimism: 0.0,
        })
    }

    /// Returns the same emulator with one more test; lengths and nugget do not change.
    pub fn with_test(&self, point: Vec<f64>, value: f64) -> Option<Self> {
        let (mut points, mut values) = (self.points.clone(), self.values.clone());
        points.push(point);
        values.push(value);
        Self::with(points, values, self.logarithms.clone())
    }

    /// Predicts the output at a point, with the standard deviation of the process there, which includes that of its mean
    /// and excludes the nugget.
    pub fn predict(&self, point: &[f64]) -> Prediction {
        self.predict_average(&self.with_tests(0..point.len(), point), 1.0)
    }

    /// Returns the mean of that prediction, in a small part of its time.
    pub fn mean(&self, point: &[f64]) -> f64 {
        self.average(&self.with_tests(0..point.len(), point))
    }

    fn average(&self, with: &DVector<f64>) -> f64 {
        self.in_unit(with.dot(&self.process.weights))
    }

    /// Returns the output at a deviation from the mean of the process.
    fn in_unit(&self, deviation: f64) -> f64 {
        self.centre + self.scale * (self.process.mean + deviation)
    }

    /// Returns the correlation of a place along some axes with every test.
    pub fn with_tests(&self, axes: Range<usize>, place: &[f64]) -> DVector<f64> {
        let lengths = &self.lengths[axes.clone()];
        let with = self.points.iter();
        let with = with.map(|own| correlation(lengths, &own[axes.clone()], place));
        DVector::from_iterator(self.points.len(), with)
    }

    /// Returns the correlation of two places along some axes.
    pub fn correlation(&self, axes: Range<usize>, one: &[f64], other: &[f64]) -> f64 {
        correlation(&self.lengths[axes], one, other)
    }

    /// Returns the contribution of every test to a mean: w_i c_i.
    pub fn contributions(&self, with: &DVector<f64>) -> DVector<f64> {
        with.component_mul(&self.process.weights)
    }

    /// Predicts a weighted mean of outputs, whose weights sum to 1, from their mean correlations `with` the tests and
    /// `among` each other.
    pub fn predict_average(&self, with: &DVector<f64>, among: f64) -> Prediction {
        let whitened = self.whitened(with);
        let variance = self.covariance([&whitened, &whitened], among).max(0.0);
        Prediction {
            mean: self.average(with),
            standard_deviation: self.scale * (self.process.variance * variance).sqrt(),
        }
    }

    /// Returns the slopes of mean and standard deviation of that prediction along the axes of `place`, whose correlations with the
    /// tests are a factor of `with`; the slope of a standard deviation of zero is zero.
    ///
    /// With the correlations c, the variance is k - c^T R^-1 c + u^2 and u = (1 - 1^T R^-1 c) / sqrt(1^T R^-1 1), so that
    /// its half slope is -(R^-1 c + u R^-1 1 / sqrt(1^T R^-1 1)) . dc.
    pub fn slopes(&self, place: &[f64], with: &DVector<f64>, among: f64) -> [DVector<f64>; 2] {
        let (process, last) = (&self.process, self.points.len());
        let whitened = self.whitened(with);
        let variance = self.covariance([&whitened, &whitened], among);
        let mut half = whitened.rows(0, last).into_owned();
        let lower = process.correlation.l_dirty();
        lower.tr_solve_lower_triangular_mut(&mut half);
        half += &process.ones * (whitened[last] / process.ones.sum().sqrt());
        let per_deviation = if variance > 0.0 {
            -(process.variance / variance).sqrt()
        } else {
            0.0
        };
        let along = |weights: &DVector<f64>, factor: f64| {
            DVector::from_fn(place.len(), |axis, _| {
                let tests = self.points.iter().zip(weights.iter().zip(with));
                let parts = tests.map(|(own, (weight, with))| {
                    weight
                        * with
                        * log_correlation_slope(place[axis], own[axis], self.lengths[axis])
                });
                factor * parts.sum::<f64>()
            })
        };
        [
            along(&process.weights, self.scale),
            along(&half, self.scale * per_deviation),
        ]
    }

    /// Returns L^-1 c, where R = L L^T, and below it (1 - 1^T R^-1 c) / sqrt(1^T R^-1 1), for the covariance of means of
    /// outputs whose correlations with the tests are c.
    pub fn whitened(&self, with: &DVector<f64>) -> DVector<f64> {
        let process = &self.process;
        let of_mean = (1.0 - with.dot(&process.ones)) / process.ones.sum().sqrt();
        let mut solved = with.clone();
        let lower = process.correlation.l_dirty();
        lower.solve_lower_triangular_mut(&mut solved);
        solved.push(of_mean)
    }

    /// Returns the covariance of two means of outputs, relative to the variance of the process, from their
    /// [`whitened`](Self::whitened) correlations and their correlation `among` each other.
    pub fn covariance(&self, [one, other]: [&DVector<f64>; 2], among: f64) -> f64 {
        let last = self.points.len();
        among - one.rows(0, last).dot(&other.rows(0, last)) + one[last] * other[last]
    }

    /// Returns the predicted means at points, and the covariance of the process there relative to its variance, without the
    /// nugget.
    pub fn joint(&self, points: &[Vec<f64>]) -> (DVector<f64>, DMatrix<f64>) {
        let axes = || 0..self.lengths.len();
        let with = points.iter().map(|one| self.with_tests(axes(), one));
        let with: Vec<DVector<f64>> = with.collect();
        let means = with.iter().map(|with| self.average(with));
        let means = DVector::from_iterator(points.len(), means);
        let whitened: Vec<DVector<f64>> = with.iter().map(|with| self.whitened(with)).collect();
        let covariance = DMatrix::from_fn(points.len(), points.len(), |row, column| {
            let among = self.correlation(axes(), &points[row], &points[column]);
            self.covariance([&whitened[row], &whitened[column]], among)
        });
        (means, covariance)
    }

    /// Returns random outputs at `points`, `count` times: joint draws from the process with its nugget; none if rounding
    /// makes their covariance indefinite.
    pub fn draws(
        &self,
        points: &[Vec<f64>],
        count: usize,
        numbers: &mut Random,
    ) -> Option<Vec<DVector<f64>>> {
        let (means, mut covariance) = self.joint(points);
        let nugget = self.joint_nugget();
        (0..points.len()).for_each(|one| covariance[(one, one)] += nugget);
        let lower = covariance.cholesky()?.unpack();
        let scale = self.scale * self.process.variance.sqrt();
        let mut draw = || {
            let normal = DVector::from_fn(points.len(), |_, _| normal_quantile(numbers.share()));
            &means + &lower * normal * scale
        };
        Some((0..count).map(|_| draw()).collect())
    }

    /// Returns the nugget, or the smallest one that keeps the covariance of close points positive definite.
    pub fn joint_nugget(&self) -> f64 {
        self.nugget().max(JOINT_NUGGET)
    }

    pub fn axes(&self) -> usize {
        self.lengths.len()
    }

    /// Returns the nugget, relative to the variance of the process.
    pub fn nugget(&self) -> f64 {
        parameters(&self.logarithms).1
    }

    /// Returns, for each test, its value minus the prediction from the other tests, and the standard deviation of this
    /// prediction: (R^-1 (y - m))_i / Q_ii and s / sqrt(Q_ii) (Dubrule 1983). Lengths, nugget and s are those of all.
    pub fn left_out(&self) -> Vec<Prediction> {
        let precisions = self.process.precisions();
        let both = self.process.weights.iter().zip(&precisions);
        let left_out = both.map(|(weight, precision)| Prediction {
            mean: self.scale * weight / precision,
            standard_deviation: self.scale * (self.process.variance / precision).sqrt(),
        });
        left_out.collect()
    }

    /// Returns the output of every test, and its prediction from all others.
    pub fn tested_and_predicted(&self) -> Vec<(f64, f64)> {
        let errors = self.left_out().into_iter().map(|error| error.mean);
        let both = self.values.iter().zip(errors);
        both.map(|(value, error)| (*value, value - error)).collect()
    }

    /// Returns the standard deviation by which a test scatters around the process, from the nugget.
    pub fn noise(&self) -> f64 {
        self.scale * (self.process.variance * self.nugget()).sqrt()
    }

    pub fn model(&self) -> Model {
        let process = &self.process;
        Model {
            lengths: self.lengths.clone(),
            nugget: self.nugget(),
            mean: self.centre + self.scale * process.mean,
            standard_deviation: self.scale * process.variance.sqrt(),
            points: self.points.clone(),
            weights: process.weights.iter().map(|one| self.scale * one).collect(),
        }
    }

    /// Returns the emulator from the tests for which `is_left_out` is false; none if it cannot be conditioned.
    pub fn without(&self, is_left_out: impl Fn(usize) -> bool) -> Option<Self> {
        let kept = || (0..self.points.len()).filter(|test| !is_left_out(*test));
        let points = kept().map(|test| self.points[test].clone()).collect();
        let values = kept().map(|test| self.values[test]).collect();
        Self::with(points, values, self.logarithms.clone())
    }

    /// Returns the emulator with standard deviations enlarged by the factor by which errors exceed them, if they do, and with the
    /// optimism of Q2. Both follow from emulators fitted to four fifths of the tests: leaving tests out of the conditioning
    /// alone would show neither, since lengths and nugget are fitted to them.
    pub fn calibrated(mut self) -> Self {
        let (mut squares, mut optimism) = (Vec::new(), 0.0);
        for fold in 0..FOLDS {
            let Some(fitted) = self.fitted_without(fold) else {
                continue;
            };
            let left_out = (fold..self.points.len()).step_by(FOLDS);
            let ratios = left_out
                .clone()
                .map(|test| fitted.standardised_error(&self.points[test], self.values[test]));
            squares.extend(ratios.map(|ratio| ratio * ratio));
            let (points, values) = (self.points.clone(), self.values.clone());
            if let Some(all) = Self::with(points, values, fitted.logarithms) {
                let errors = all.squared_left_out();
                let own: f64 = left_out.map(|test| errors[test]).sum();
                optimism += own - errors.iter().sum::<f64>() / FOLDS as f64;
            }
        }
        self.process.variance *= mean(&squares).max(1.0);
        // Lengths fitted without a test predict it better than others only by chance.
        self.optimism = optimism.max(0.0);
        self
    }

    /// Returns the error of the prediction of a test, relative to its standard deviation.
    fn standardised_error(&self, point: &[f64], value: f64) -> f64 {
        let found = self.predict(point);
        let deviation = found.standard_deviation.hypot(self.noise());
        (value - found.mean) / deviation.max(f64::MIN_POSITIVE)
    }

    /// Returns the squared error of every test, predicted from all others.
    fn squared_left_out(&self) -> Vec<f64> {
        let errors = self.left_out().into_iter().map(|one| one.mean);
        errors.map(|error| error * error).collect()
    }

    /// Returns an emulator fitted to all tests but every fifth; none if they allow no fit, or are constant, as where the only test
    /// that failed is among the fifth: their deviation of zero says nothing of that of all.
    fn fitted_without(&self, fold: usize) -> Option<Self> {
        let kept = (0..self.points.len()).filter(|test| test % FOLDS != fold);
        let kept = kept.map(|test| (self.points[test].clone(), self.values[test]));
        let (points, values): (Vec<_>, Vec<_>) = kept.unzip();
        if standard_deviation(&values) < CONSTANT * self.scale {
            return None;
        }
        Self::fit(&points, &values)
    }

    /// Returns the first and the total Sobol index of every axis for the mean of the process, and its main effects: the mean of
    /// the output at each node of an axis over all nodes of the others, in the unit of the output.
    ///
    /// `nodes` are equally likely places along each axis, the same number on each. The mean is a sum over the tests of products over the axes,
    /// w_i c_1(x_1) c_2(x_2) ..., so that main effects are products of means over one axis (Oakley and O'Hagan 2004). What is left of
    /// the output beyond them is averaged over Sobol points among the nodes. Its variance is a double sum over the tests as well,
    /// but for a smooth output the weights are up to 1e8, and rounding of their products is as large as the variance.
    pub fn indices(&self, nodes: &[Vec<f64>]) -> (Vec<[f64; 2]>, Vec<Vec<f64>>) {
        let (axes, count, weights) = (nodes.len(), nodes[0].len(), &self.process.weights);
        let with_nodes = (0..axes).map(|axis| {
            let with_nodes = nodes[axis].iter();
            let with_nodes = with_nodes.map(|node| self.with_tests(axis..axis + 1, &[*node]));
            DMatrix::from_columns(&with_nodes.collect::<Vec<_>>())
        });
        let with_nodes: Vec<DMatrix<f64>> = with_nodes.collect();
        let others = |axis: usize| (0..axes).filter(move |other| *other != axis);
        let product = |axis: usize, with: &dyn Fn(usize) -> DVector<f64>| {
            others(axis).fold(weights.clone(), |all, one| all.component_mul(&with(one)))
        };
        let effect = |axis: usize| -> DVector<f64> {
            with_nodes[axis].tr_mul(&product(axis, &|other| with_nodes[other].column_mean()))
        };
        let mean = effect(0).mean();
        // Without their common mean: otherwise variances are differences of large numbers.
        let effect = |axis| effect(axis).add_scalar(-mean);
        let effects: Vec<DVector<f64>> = (0..axes).map(effect).collect();
        let own: Vec<f64> = effects
            .iter()
            .map(|one| one.norm_squared() / count as f64)
            .collect();
        let samples = (0..SAMPLES).map(|row| {
            let shares = sobol_shares(row, axes, SAMPLES_SEED);
            shares
                .map(|share| (share * count as f64) as usize)
                .collect()
        });
        let samples: Vec<Vec<usize>> = samples.collect();
        // The variance of what is left, and the mean of its variance along the axis.
        let left = |axis: usize| {
            let along = |sample: &Vec<usize>| {
                product(axis, &|other| {
                    with_nodes[other].column(sample[other]).into_owned()
                })
            };
            let along: Vec<DVector<f64>> = samples.iter().map(along).collect();
            let mut left = DMatrix::from_columns(&along).transpose() * &with_nodes[axis];
            for (sample, mut row) in samples.iter().zip(left.row_iter_mut()) {
                let of_others = others(axis).map(|other| effects[other][sample[other]]);
                let of_others: f64 = of_others.sum();
                row -= effects[axis].transpose().add_scalar(mean + of_others);
            }
            let within = left.row_iter().map(|row| row.variance()).sum::<f64>();
            let squares = left.norm_squared() / left.len() as f64;
            [squares, within / SAMPLES as f64]
        };
        let left: Vec<[f64; 2]> = (0..axes).map(left).collect();
        let squares = left.iter().map(|one| one[0]).sum::<f64>() / axes as f64;
        let variance = own.iter().sum::<f64>() + squares;
        let both = own.iter().zip(left);
        let indices = both.map(|(own, [_, within])| [*own, own + within].map(|one| one / variance));
        let in_unit = |effect: &DVector<f64>| {
            let means = effect.iter().map(|one| self.in_unit(mean + one));
            means.collect()
        };
        (indices.collect(), effects.iter().map(in_unit).collect())
    }

    /// Returns Q2, the share of the variance of the values that predictions from the other tests explain, without the optimism if
    /// the emulator is calibrated; 1 for constant values.
    pub fn q2(&self) -> f64 {
        let errors = self.squared_left_out().iter().sum::<f64>() + self.optimism;
        let mean = mean(&self.values);
        let squares = self.values.iter().map(|value| (value - mean).powi(2));
        let all: f64 = squares.sum();
        if all == 0.0 { 1.0 } else { 1.0 - errors / all }
    }
}

/// Returns values less their mean over their standard deviation, and these two; 1 instead of a standard deviation of 0.
fn scaled(values: &[f64]) -> (DVector<f64>, [f64; 2]) {
    let (centre, deviation) = (mean(values), standard_deviation(values));
    let scale = if deviation > 0.0 { deviation } else { 1.0 };
    let scaled = values.iter().map(|value| (value - centre) / scale);
    (
        DVector::from_iterator(values.len(), scaled),
        [centre, scale],
    )
}
