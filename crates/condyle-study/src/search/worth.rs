//! Emulators of a search, and the worth of a test by them.

use std::f64::consts::PI;

use nalgebra::DVector;

use super::{
    observed::{Observed, space_filling},
    outlook::Outlook,
};
use crate::{
    descent::minimum,
    distribution::{normal_quantile, normal_share},
    emulator::Emulator,
    random::Random,
};

/// Factor of all standard deviations where the optimum that the emulators predict is tested: it then lies within the
/// predicted limits by about this part of them.
pub(super) const SHARP: f64 = 0.1;
/// Factor on all standard deviations during exploration: with few tests, those of the emulators are
/// too small far from all tests, and the search would end too early.
pub(super) const WIDE: f64 = 2.0;
/// Number of candidate points for each input and around the best test; the most promising become starting points.
const CANDIDATES_PER_INPUT: usize = 64;
const CANDIDATES_AROUND: usize = 64;
const STARTS: usize = 6;
/// Share of the disturbances under which a robust optimum must be solved.
const SOLVED: f64 = 0.95;

/// Emulators of the minimised outputs and of the excess over each limit, and for tests that failed also of the failure.
pub(super) struct Emulators {
    pub minimised: Vec<Outlook>,
    pub limits: Vec<Outlook>,
    /// The tests, in a robust search with the predicted statistics of their designs.
    pub seen: Observed,
    /// The minimised outputs of the best tests: of one, or of those on the front by the first output.
    pub front: Vec<Vec<f64>>,
    front_points: Vec<Vec<f64>>,
    /// The worst values of the minimised outputs within the limits.
    worst: Vec<f64>,
}

impl Emulators {
    /// Fits the emulators; none while too few tests are done.
    pub fn new(observed: &Observed) -> Option<Self> {
        let (done, failed): (Vec<usize>, Vec<usize>) =
            (0..observed.points.len()).partition(|place| observed.is_done(*place));
        let points: Vec<Vec<f64>> = done
            .iter()
            .map(|&one| observed.points[one].clone())
            .collect();
        let fit = |values: &Vec<f64>, share: Option<f64>| {
            let values: Vec<f64> = done.iter().map(|&one| values[one]).collect();
            let emulator = Emulator::fit(&points, &values)?;
            Some(Outlook::new(emulator, &observed.disturbances, share))
        };
        let limits = observed.excess.iter().zip(&observed.kept);
        let limits = limits.map(|(excess, kept)| fit(excess, Some(*kept)));
        let mut limits: Vec<Outlook> = limits.collect::<Option<_>>()?;
        if !failed.is_empty() {
            // Half way between a test that failed and one that was done lies the limit.
            let mut failure = vec![-0.5; observed.points.len()];
            failed.iter().for_each(|&one| failure[one] = 0.5);
            let failure = Emulator::fit(&observed.points, &failure)?;
            limits.push(Outlook::new(failure, &observed.disturbances, Some(SOLVED)));
        }
        let minimised = observed.minimised.iter();
        let minimised: Vec<Outlook> = minimised
            .map(|values| fit(values, observed.share))
            .collect::<Option<_>>()?;
        let seen = if observed.disturbances.is_empty() {
            observed.clone()
        } else {
            predicted(observed, &minimised, &limits)
        };
        let best = seen.best();
        let of_best = |place: &usize| seen.minimised.iter().map(|all| all[*place]).collect();
        let design = |&place: &usize| seen.design(place).to_vec();
        Some(Self {
            front: best.iter().map(of_best).collect(),
            front_points: best.iter().map(design).collect(),
            worst: seen.ranges().iter().map(|range| range[1]).collect(),
            minimised,
            limits,
            seen,
        })
    }

    /// Returns the logarithm of the worth of a test: its expected improvement of the best test (Jones, Schonlau and Welch
    /// 1998), or of the hypervolume of a front, times the probability that it keeps all limits (Schonlau, Welch and Jones
    /// 1998); without a best test, the probability alone. `share` multiplies the standard deviations of all predictions. Along
    /// levels it is constant from one to the next, so that an ascent keeps the levels of its start.
    fn worth(&self, point: &[f64], share: f64, needs_slope: bool) -> Graded {
        let point = self.seen.snapped(point);
        let axes = if needs_slope { point.len() } else { 0 };
        let found = |outlook: &Outlook| {
            let found = outlook.predict(&point);
            let [mean, deviation] = match needs_slope {
                true => outlook.slopes(&point),
                false => [DVector::zeros(0), DVector::zeros(0)],
            };
            let deviation = (share * found.standard_deviation, share * deviation);
            Found {
                mean: (found.mean, mean),
                deviation: (deviation.0.max(f64::MIN_POSITIVE), deviation.1),
            }
        };
        let mut worth = (0.0, DVector::zeros(axes));
        let mut add = |(value, slope): Graded| {
            worth.0 += value;
            worth.1 += slope;
        };
        for limit in &self.limits {
            let (z, slope) = found(limit).standardised(0.0);
            add((log_share(z), slope * (log_density(z) - log_share(z)).exp()));
        }
        match (&self.minimised[..], &self.front[..]) {
            (_, []) => {}
            ([one], [best, ..]) => add(found(one).log_expected_below(best[0])),
            ([one, other, ..], _) => add(self.log_hypervolume([found(one), found(other)])),
            ([], _) => add((f64::NEG_INFINITY, DVector::zeros(axes))),
        }
        if needs_slope {
            let levels = self.seen.levels.iter().enumerate();
            let stepped = levels.filter(|(_, levels)| !levels.is_empty());
            stepped.for_each(|(axis, _)| worth.1[axis] = 0.0);
        }
        worth
    }

    /// Returns the logarithm of the expected growth of the area that the front beats below the worst values
    /// (Emmerich, Deutz and Klinkenberg 2011): the integral of the probability that both outputs
    /// are below a place, over all places that the front does not beat, strip by strip.
    fn log_hypervolume(&self, [one, other]: [Found; 2]) -> Graded {
        let ends = self.front.iter().map(|test| test[0]).chain([self.worst[0]]);
        let tops = [self.worst[1]]
            .into_iter()
            .chain(self.front.iter().map(|test| test[1]));
        let below = |found: &Found, value: f64| {
            let (logarithm, slope) = found.log_expected_below(value);
            (logarithm.exp(), slope * logarithm.exp())
        };
        let none = || (0.0, DVector::zeros(one.mean.1.len()));
        let (mut before, mut area) = (none(), none());
        for (end, top) in ends.zip(tops) {
            let (wide, high) = (below(&one, end), below(&other, top));
            area.0 += (wide.0 - before.0) * high.0;
            area.1 += (&wide.1 - &before.1) * high.0 + &high.1 * (wide.0 - before.0);
            before = wide;
        }
        (area.0.ln(), area.1 / area.0)
    }

    /// Returns the point of the largest worth and the worth there: the best descent from the most promising of many
    /// points; none if no point has a finite worth.
    pub fn most_promising(
        &self,
        observed: &Observed,
        share: f64,
        seed: u64,
    ) -> Option<(Vec<f64>, f64)> {
        let candidates = self.candidates(observed, seed);
        let axes = observed.chosen();
        let mut starts: Vec<(f64, Vec<f64>)> = candidates
            .into_iter()
            .map(|point| (self.worth(&point, share, false).0, point))
            .filter(|(worth, _)| worth.is_finite())
            .collect();
        starts.sort_by(|one, other| other.0.total_cmp(&one.0));
        let worthless = |point: &DVector<f64>| {
            let (worth, slope) = self.worth(point.as_slice(), share, true);
            let is_finite = worth.is_finite() && slope.iter().all(|one| one.is_finite());
            is_finite.then(|| (-worth, -slope))
        };
        let ends = [0.0, 1.0].map(|end| DVector::from_element(axes, end));
        let ascents = starts.into_iter().take(STARTS).filter_map(|(_, point)| {
            minimum(&worthless, DVector::from_vec(point), [&ends[0], &ends[1]])
        });
        let most = ascents.min_by(|one, other| one.1.total_cmp(&other.1))?;
        Some((observed.snapped(most.0.as_slice()), -most.1))
    }

    /// Returns space-filling points and points around the best test, others after every test.
    fn candidates(&self, observed: &Observed, seed: u64) -> Vec<Vec<f64>> {
        let (axes, row) = (observed.chosen(), observed.points.len());
        let count = CANDIDATES_PER_INPUT * axes;
        let filling = space_filling(row * count..(row + 1) * count, axes, seed);
        filling.chain(self.around_best(seed, row)).collect()
    }

    /// Returns points around the best test, at distances that decrease from a fifth of the ranges.
    fn around_best(&self, seed: u64, row: usize) -> Vec<Vec<f64>> {
        let mut numbers = Random::stream(seed, row as u64);
        let mut around = |number: usize| {
            let distance = 0.2 * 0.5_f64.powi((number % 8) as i32);
            let mut moved =
                |one: &f64| (one + distance * normal_quantile(numbers.share())).clamp(0.0, 1.0);
            let best = &self.front_points[number % self.front_points.len()];
            best.iter().map(&mut moved).collect::<Vec<f64>>()
        };
        let count = if self.front.is_empty() {
            0
        } else {
            CANDIDATES_AROUND
        };
        (0..count).map(&mut around).collect()
    }

    /// Adds a test with the results that the emulators predict; none, without a change, if one of them cannot take it.
    pub fn believe(&mut self, point: &[f64]) -> Option<()> {
        let believing = |all: &[Outlook]| {
            let all = all.iter().map(|one| one.believing(point));
            all.collect::<Option<Vec<Outlook>>>()
        };
        let both = (believing(&self.minimised)?, believing(&self.limits)?);
        (self.minimised, self.limits) = both;
        Some(())
    }

    /// Returns a test of a design: under the disturbance that tells most about its outputs, and about limits that it may or
    /// may not keep.
    pub fn test_of(&self, design: &[f64], observed: &Observed) -> Vec<f64> {
        let doubt = |limit: &Outlook| {
            let found = limit.predict(design);
            let kept = normal_share(-found.mean / found.standard_deviation.max(f64::MIN_POSITIVE));
            4.0 * kept * (1.0 - kept) * limit.gains(design)
        };
        if observed.disturbances.is_empty() {
            return design.to_vec();
        }
        let minimised = self.minimised.iter().map(|one| one.gains(design));
        let gains = minimised.chain(self.limits.iter().map(doubt));
        let most = gains.reduce(|one, other| one + other).map(|all| all.imax());
        let under = &observed.disturbances[most.unwrap_or_default()];
        [design, under.as_slice()].concat()
    }
}

/// Returns the tests with the predicted statistics of their designs in place of their own outputs.
fn predicted(observed: &Observed, minimised: &[Outlook], limits: &[Outlook]) -> Observed {
    let all = |outlook: &Outlook| {
        let places = 0..observed.points.len();
        let mean = |place| outlook.predict(observed.design(place)).mean;
        places.map(mean).collect::<Vec<f64>>()
    };
    Observed {
        minimised: minimised.iter().map(all).collect(),
        excess: limits.iter().map(all).collect(),
        ..observed.clone()
    }
}

/// A number and its slope along the chosen inputs, which is empty where it is not needed.
type Graded = (f64, DVector<f64>);

/// A predicted output of a design.
struct Found {
    mean: Graded,
    /// The standard deviation, > 0.
    deviation: Graded,
}

impl Found {
    /// Returns z = (value - mean) / deviation.
    fn standardised(&self, value: f64) -> Graded {
        let (deviation, slope) = &self.deviation;
        let z = (value - self.mean.0) / deviation;
        (z, -(&self.mean.1 + slope * z) / *deviation)
    }

    /// Returns the logarithm of the expectation of max(0, value - y) for the output y.
    fn log_expected_below(&self, value: f64) -> Graded {
        let ((z, slope), (deviation, of_deviation)) = (self.standardised(value), &self.deviation);
        let improvement = log_improvement(z);
        let by_z = (log_share(z) - improvement).exp();
        (
            deviation.ln() + improvement,
            of_deviation / *deviation + slope * by_z,
        )
    }
}

/// Below this, the tails of the normal distribution follow from their asymptotic series to seven digits.
const TAIL: f64 = -20.0;

/// Returns the logarithm of the standard normal density.
fn log_density(z: f64) -> f64 {
    -0.5 * (z * z + (2.0 * PI).ln())
}

/// Returns the logarithm of the share of the standard normal distribution below `z`.
fn log_share(z: f64) -> f64 {
    if z > TAIL {
        return normal_share(z).ln();
    }
    let square = 1.0 / (z * z);
    log_density(z) - (-z).ln() + (1.0 - square * (1.0 - square * (3.0 - 15.0 * square))).ln()
}

/// Returns the logarithm of the expectation of max(0, z - t) for a standard normal t: of density(z) + z share(z), which
/// underflows far from the best test (Ament et al. 2023).
fn log_improvement(z: f64) -> f64 {
    if z > TAIL {
        return (log_density(z).exp() + z * normal_share(z)).ln();
    }
    let square = 1.0 / (z * z);
    log_density(z) + square.ln() + (1.0 - square * (3.0 - square * (15.0 - 105.0 * square))).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a search of three axes, the last of which is that of the disturbances of a robust one, with a limit.
    fn searched(objectives: usize, disturbances: &[Vec<f64>]) -> Observed {
        let points: Vec<Vec<f64>> = space_filling(0..16, 3, 1).collect();
        // Waves, of which 16 tests leave much unknown: where all is known, differences are rounding errors.
        let waves = |at: f64| {
            let wave = |point: &Vec<f64>| point.iter().map(|x| (9.0 * (x - at)).sin()).sum();
            points.iter().map(wave).collect::<Vec<f64>>()
        };
        Observed {
            minimised: [0.3, 0.8][..objectives]
                .iter()
                .map(|&at| waves(at))
                .collect(),
            excess: vec![
                points
                    .iter()
                    .map(|x| (7.0 * x[0]).sin() + (8.0 * x[1] * x[2]).sin() - 0.5)
                    .collect(),
            ],
            kept: vec![0.9],
            share: (!disturbances.is_empty()).then_some(0.9),
            disturbances: disturbances.to_vec(),
            points,
            ..Observed::default()
        }
    }

    #[test]
    fn verify_slopes_of_the_worth() {
        const STEP: f64 = 1e-6;
        let disturbed: Vec<Vec<f64>> = (0..9).map(|n| vec![0.1 * f64::from(n) + 0.1]).collect();
        for (objectives, disturbances) in [(1, &[][..]), (2, &[]), (1, &disturbed)] {
            let observed = searched(objectives, disturbances);
            let emulators = Emulators::new(&observed).unwrap();
            let axes = observed.chosen();
            for point in space_filling(40..50, axes, 1) {
                let (_, slope) = emulators.worth(&point, WIDE, true);
                for axis in 0..axes {
                    let moved = |by: f64| {
                        let mut moved = point.clone();
                        moved[axis] += by;
                        emulators.worth(&moved, WIDE, false).0
                    };
                    let difference = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
                    let apart = (slope[axis] - difference).abs();
                    assert!(
                        apart < 1e-5 * (1.0 + slope.norm()),
                        "{objectives} {axis} {slope} {difference}"
                    );
                }
            }
        }
    }

    #[test]
    fn verify_logarithms_in_the_tails() {
        // Both formulas agree where they meet, and those of the centre with the definition.
        for of in [log_share, log_improvement] {
            let [below, above] = [TAIL - 1e-9, TAIL + 1e-9].map(of);
            assert!((below - above).abs() < 1e-6, "{below} {above}");
        }
        assert!((log_share(0.0) - 0.5_f64.ln()).abs() < 1e-15);
        assert!((log_improvement(0.0) + 0.5 * (2.0 * PI).ln()).abs() < 1e-14);
    }
}
