//! The Gaussian process behind an emulator, conditioned on centred and scaled values, and its likelihood.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Variance of a process relative to that of its values below which it is constant.
const MIN_VARIANCE: f64 = 1e-20;

/// The conditioned process, for values that are centred and scaled.
#[derive(Clone)]
pub(super) struct Process {
    pub correlation: Cholesky<f64, Dyn>,
    /// R^-1 1.
    pub ones: DVector<f64>,
    /// R^-1 (y - mean).
    pub weights: DVector<f64>,
    pub mean: f64,
    pub variance: f64,
}

/// Returns the distance of two values along an axis in units in which their correlation is (1 + a + a^2 / 3) e^-a.
fn scaled_distance(one: f64, other: f64, length: f64) -> f64 {
    5.0_f64.sqrt() * (one - other).abs() / length
}

pub(super) fn correlation(lengths: &[f64], one: &[f64], other: &[f64]) -> f64 {
    let axes = one.iter().zip(other).zip(lengths);
    let (mut product, mut distance) = (1.0, 0.0);
    for ((one, other), length) in axes {
        let a = scaled_distance(*one, *other, *length);
        product *= 1.0 + a + a * a / 3.0;
        distance += a;
    }
    product * (-distance).exp()
}

/// Returns the derivative of the logarithm of a correlation with respect to the place `one` along an axis.
pub(super) fn log_correlation_slope(one: f64, other: f64, length: f64) -> f64 {
    let a = scaled_distance(one, other, length);
    -decay(a) * 5.0_f64.sqrt() / length * (one - other).signum()
}

/// Returns the relative decrease of the correlation along an axis with the scaled distance a.
fn decay(a: f64) -> f64 {
    a * (1.0 + a) / (3.0 + 3.0 * a + a * a)
}

impl Process {
    /// Conditions a process on values; none if rounding makes the correlation indefinite.
    pub fn new(
        points: &[Vec<f64>],
        values: &DVector<f64>,
        logarithms: &DVector<f64>,
    ) -> Option<Self> {
        let (lengths, nugget) = parameters(logarithms);
        let count = points.len();
        let mut matrix = DMatrix::identity(count, count) * (1.0 + nugget);
        for column in 0..count {
            for row in column + 1..count {
                matrix[(row, column)] = correlation(&lengths, &points[row], &points[column]);
            }
        }
        // The factorisation reads the lower triangle.
        let correlation = matrix.cholesky()?;
        let ones = correlation.solve(&DVector::from_element(count, 1.0));
        let mean = ones.dot(values) / ones.sum();
        let weights = correlation.solve(&values.add_scalar(-mean));
        let variance = values.add_scalar(-mean).dot(&weights) / count as f64;
        Some(Self {
            correlation,
            ones,
            weights,
            mean,
            variance: variance.max(MIN_VARIANCE),
        })
    }

    /// Returns n ln s^2 + ln |R|, twice the negative logarithm of the likelihood, less a constant, at the likeliest mean
    /// and variance s^2.
    pub fn deviance(&self) -> f64 {
        let count = self.weights.len() as f64;
        let diagonal = self.correlation.l_dirty().diagonal();
        count * self.variance.ln() + 2.0 * diagonal.iter().map(|one| one.ln()).sum::<f64>()
    }

    /// Returns the derivatives of the deviance with respect to the logarithms: tr(R^-1 dR) - w^T dR w / s^2, where
    /// w are the weights.
    pub fn slope(&self, points: &[Vec<f64>], logarithms: &DVector<f64>) -> DVector<f64> {
        let (lengths, nugget) = parameters(logarithms);
        let inverse = self.correlation.inverse();
        let factor = |row: usize, column: usize| {
            inverse[(row, column)] - self.weights[row] * self.weights[column] / self.variance
        };
        let mut slope = DVector::zeros(logarithms.len());
        for column in 0..points.len() {
            slope[lengths.len()] += nugget * factor(column, column);
            for row in column + 1..points.len() {
                let (one, other) = (&points[row], &points[column]);
                // Twice, for both triangles.
                let both = 2.0 * factor(row, column) * correlation(&lengths, one, other);
                for (axis, length) in lengths.iter().enumerate() {
                    let a = scaled_distance(one[axis], other[axis], *length);
                    slope[axis] += both * a * decay(a);
                }
            }
        }
        slope
    }

    /// Returns the diagonal of Q = R^-1 - R^-1 1 1^T R^-1 / (1^T R^-1 1).
    pub fn precisions(&self) -> DVector<f64> {
        let sum = self.ones.sum();
        let inverse = self.correlation.inverse().diagonal();
        inverse - self.ones.component_mul(&self.ones) / sum
    }
}

pub(super) fn parameters(logarithms: &DVector<f64>) -> (Vec<f64>, f64) {
    let mut all: Vec<f64> = logarithms.iter().map(|one| one.exp()).collect();
    let nugget = all.pop().unwrap_or_default();
    (all, nugget)
}
