//! The tests of a search in the unit cube.

use crate::{design::sobol::sobol_shares, statistics::extent};

/// A search ends once another test is expected to improve the optimum by less than this part of the range of the
/// minimised output within the limits.
const MIN_IMPROVEMENT: f64 = 1e-4;

/// Returns rows of scrambled Sobol points.
pub(super) fn space_filling(
    rows: impl Iterator<Item = usize>,
    axes: usize,
    seed: u64,
) -> impl Iterator<Item = Vec<f64>> {
    rows.map(move |row| sobol_shares(row as u64, axes, seed).collect())
}

/// The same for a robust search, whose statistics are known less exactly than the outputs of a test.
const MIN_ROBUST_IMPROVEMENT: f64 = 1e-3;

/// Tests in the unit cube.
#[derive(Clone, Default)]
pub(super) struct Observed {
    /// Chosen inputs, then disturbances.
    pub points: Vec<Vec<f64>>,
    /// The places of the levels of each chosen input; none for a continuous one.
    pub levels: Vec<Vec<f64>>,
    /// The disturbances under which a design is judged; none in a search that is not robust.
    pub disturbances: Vec<Vec<f64>>,
    /// The share of the disturbances below the percentile that is minimised; none for the mean.
    pub share: Option<f64>,
    /// The share of the disturbances that must keep each limit.
    pub kept: Vec<f64>,
    /// The minimised output, or both outputs of a Pareto front; NaN for a test that failed.
    pub minimised: Vec<Vec<f64>>,
    /// For each limit, the amount by which a test exceeds it; negative within the limit.
    pub excess: Vec<Vec<f64>>,
}

impl Observed {
    /// Returns the number of inputs that the search chooses.
    pub fn chosen(&self) -> usize {
        let disturbances = self.disturbances.first().map_or(0, Vec::len);
        self.points.first().map_or(0, Vec::len) - disturbances
    }

    /// Returns the chosen inputs of a test.
    pub fn design(&self, place: usize) -> &[f64] {
        &self.points[place][..self.chosen()]
    }

    pub fn is_done(&self, place: usize) -> bool {
        self.minimised.iter().all(|all| all[place].is_finite())
    }

    /// Returns whether a test is done and within all limits.
    pub fn is_within(&self, place: usize) -> bool {
        self.is_done(place) && self.excess.iter().all(|excess| excess[place] <= 0.0)
    }

    /// Returns the tests within all limits that no other one beats: for one output that with the smallest, for two the
    /// front, by the first output.
    pub fn best(&self) -> Vec<usize> {
        let within: Vec<usize> = (0..self.points.len())
            .filter(|place| self.is_within(*place))
            .collect();
        let is_beaten = |own: usize, other: usize| {
            let both = self.minimised.iter().map(|all| (all[own], all[other]));
            let is_equal = both.clone().all(|(own, other)| own == other);
            both.clone().all(|(own, other)| other <= own) && (!is_equal || other < own)
        };
        let mut best = within.clone();
        best.retain(|&own| !within.iter().any(|&other| is_beaten(own, other)));
        best.sort_by(|&one, &other| self.minimised[0][one].total_cmp(&self.minimised[0][other]));
        best
    }

    /// Returns the least and the most of every minimised output in tests within all limits.
    pub fn ranges(&self) -> Vec<[f64; 2]> {
        let within = || (0..self.points.len()).filter(|place| self.is_within(*place));
        let outputs = self.minimised.iter();
        outputs
            .map(|all| extent(within().map(|place| all[place])))
            .collect()
    }

    /// Returns whether the logarithm of an expected improvement is too small for another test.
    pub fn is_exhausted(&self, worth: f64) -> bool {
        let ranges = self.ranges();
        let whole: f64 = ranges.iter().map(|[low, high]| high - low).product();
        let part = if self.disturbances.is_empty() {
            MIN_IMPROVEMENT
        } else {
            MIN_ROBUST_IMPROVEMENT
        };
        worth < (part * whole).ln()
    }
}
