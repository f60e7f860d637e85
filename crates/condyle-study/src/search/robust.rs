//! Compares the robust optimum with the starting design, by joint draws from the emulators.

use nalgebra::DVector;
use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF};

use super::{
    Known, disturbances, observed,
    observed::Observed,
    outlook::{Outlook, percentile_weights},
    starting_test,
    worth::Emulators,
};
use crate::{
    plan::Plan,
    random::Random,
    statistics::{central_interval, mean},
};

/// Disturbances under which both designs are compared.
const COMPARED: usize = 256;
/// Joint draws from the emulators, for intervals.
const DRAWS: usize = 400;

/// Seed of the draws: answers are the same whenever they are computed.
const SEED: u64 = 19_820_901;

/// A number with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Estimate {
    pub value: f64,
    pub interval: [f64; 2],
}

impl Estimate {
    /// Returns a probability of the solved tests as one of all tests, of which a share failed and may belong to it.
    pub fn with_failed(self, share: f64) -> Self {
        let [low, high] = self.interval.map(|end| end * (1.0 - share));
        let interval = [low, high + share];
        Self { interval, ..self }
    }
}

/// A design of a robust search, by the emulators.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Judged {
    /// The row of a test of the design.
    pub row: usize,
    /// The mean or the percentile that the search minimises.
    pub statistic: Estimate,
    /// The probability of keeping each side of each limit, then, if tests failed, of being solved, then of all of these.
    pub kept: Vec<Estimate>,
    /// The predicted output under each disturbance, smallest first.
    #[serde(skip)]
    pub outputs: Vec<f64>,
}

/// The robust optimum and the design that the search starts from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Comparison {
    pub optimum: Judged,
    pub first: Judged,
    /// The probability that the optimum has the smaller output under the same disturbance, or is solved where the first design
    /// is not.
    pub beats: Estimate,
}

/// Returns the comparison of the robust optimum with the first design; none for another search, and while no tested design
/// keeps the limits.
pub(crate) fn comparison(plan: &Plan, known: &[Known]) -> Option<Comparison> {
    let disturbances = disturbances(plan, COMPARED, SEED);
    let observed = observed(plan, known);
    if disturbances.is_empty() {
        return None;
    }
    let observed = Observed {
        disturbances,
        ..observed
    };
    observed.comparison(starting_test(plan, known))
}

/// The draws of an output: for each draw, the output of both designs under each disturbance.
type Draws = Vec<[Vec<f64>; 2]>;

/// Joint draws of all outputs, each with a random sample of the disturbances, whose number limits what they tell.
struct Sampled {
    samples: Vec<Vec<usize>>,
    outputs: Draws,
    excess: Vec<Draws>,
}

impl Observed {
    /// Compares the optimum with the design of test `start`.
    fn comparison(&self, start: usize) -> Option<Comparison> {
        let emulators = Emulators::new(self)?;
        let ([minimised], [best]) = (&emulators.minimised[..], &emulators.seen.best()[..]) else {
            return None;
        };
        let mut numbers = Random::stream(SEED, 0);
        let mut draws = |outlook: &Outlook| self.draws(outlook, [*best, start], &mut numbers);
        let outputs = draws(minimised)?;
        let excess = emulators.limits.iter().map(draws).collect::<Option<_>>()?;
        let count = self.disturbances.len();
        let sample = |_| (0..count).map(|_| numbers.index(count)).collect();
        let sampled = Sampled {
            samples: (0..DRAWS).map(sample).collect(),
            outputs,
            excess,
        };
        let weights = self.share.map(|share| percentile_weights(count, share));
        let judged = |design: usize, row: usize| {
            let mut outputs = minimised.outputs(self.design(row));
            outputs.sort_by(f64::total_cmp);
            Judged {
                row,
                statistic: sampled.statistic(design, weights.as_ref()),
                kept: sampled.kept(design),
                outputs,
            }
        };
        // After the limits: a design that cannot be solved is worse than one that is.
        let failure = sampled.excess.get(self.excess.len());
        let beats = |draw: usize, at: usize| {
            let is_solved = |design: usize| failure.is_none_or(|all| all[draw][design][at] <= 0.0);
            let [own, first] = [0, 1].map(|design| sampled.outputs[draw][design][at]);
            is_solved(0) && (!is_solved(1) || own < first)
        };
        Some(Comparison {
            beats: sampled.share(beats),
            optimum: judged(0, *best),
            first: judged(1, start),
        })
    }

    /// Draws an output of the designs of two tests.
    fn draws(&self, outlook: &Outlook, tests: [usize; 2], numbers: &mut Random) -> Option<Draws> {
        let at = |row: usize| {
            let under = self.disturbances.iter();
            under.map(move |one| [self.design(row), one].concat())
        };
        let points: Vec<Vec<f64>> = tests.into_iter().flat_map(at).collect();
        let emulator = outlook.emulator.clone().calibrated();
        let draws = emulator.draws(&points, DRAWS, numbers)?.into_iter();
        let halves = |draw: DVector<f64>| {
            let (optimum, first) = draw.as_slice().split_at(self.disturbances.len());
            [optimum.to_vec(), first.to_vec()]
        };
        Some(draws.map(halves).collect())
    }
}

impl Sampled {
    /// Returns the probability of a disturbance for which something is true of a draw. Each draw adds one of the
    /// probabilities that give as many of the disturbances, of Jeffreys' beta distribution, whose interval does not collapse
    /// when it is true for all or none (Brown, Cai and DasGupta 2001).
    fn share(&self, is: impl Fn(usize, usize) -> bool) -> Estimate {
        let mut numbers = Random::stream(SEED, 1);
        let mut shares = Vec::new();
        let mut probability = |(draw, sample): (usize, &Vec<usize>)| {
            let count = sample.len() as f64;
            let hits = (0..sample.len()).filter(|&at| is(draw, at)).count() as f64;
            shares.push(hits / count);
            let beta = Beta::new(hits + 0.5, count - hits + 0.5);
            beta.map_or(f64::NAN, |beta| beta.inverse_cdf(numbers.share()))
        };
        let samples = self.samples.iter().enumerate();
        let [low, high] = central_interval(samples.map(&mut probability).collect());
        let value = mean(&shares);
        Estimate {
            value,
            interval: [low.min(value), high.max(value)],
        }
    }

    /// Returns the mean of a design, or with weights of ranks a percentile.
    fn statistic(&self, design: usize, weights: Option<&DVector<f64>>) -> Estimate {
        let both = self.samples.iter().zip(&self.outputs);
        let statistic = |(sample, outputs): (&Vec<usize>, &[Vec<f64>; 2])| {
            let mut values: Vec<f64> = sample.iter().map(|&at| outputs[design][at]).collect();
            let Some(weights) = weights else {
                return mean(&values);
            };
            values.sort_by(f64::total_cmp);
            weights.dot(&DVector::from_vec(values))
        };
        let statistics: Vec<f64> = both.map(statistic).collect();
        Estimate {
            value: mean(&statistics),
            interval: central_interval(statistics),
        }
    }

    fn kept(&self, design: usize) -> Vec<Estimate> {
        let is_kept = |all: &Draws, draw: usize, at: usize| all[draw][design][at] <= 0.0;
        let each = self.excess.iter();
        let each = each.map(|one| self.share(|draw, at| is_kept(one, draw, at)));
        let all = |draw, at| self.excess.iter().all(|one| is_kept(one, draw, at));
        each.chain([self.share(all)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        distribution::{normal_quantile, normal_share},
        search::{BATCH, first_tests, observed::space_filling},
    };

    /// Searches for the least mean, or percentile, of (x - 0.3)^2 + (x - 0.8)^2 u^2 + y with u of the standard normal
    /// distribution, where u / 5 + 0.5 - y must not be positive with a probability of 95 %.
    fn searched(share: Option<f64>, size: usize, seed: u64) -> Observed {
        let normal = |share: f64| normal_quantile(share) / 4.0 + 0.5;
        let under = space_filling(0..128, 1, !seed);
        let mut observed = Observed {
            disturbances: under.map(|one| vec![normal(one[0])]).collect(),
            share,
            kept: vec![0.95],
            minimised: vec![Vec::new()],
            excess: vec![Vec::new()],
            ..Observed::default()
        };
        let test = |observed: &mut Observed, point: Vec<f64>| {
            let (x, y, u) = (point[0], point[1], 4.0 * point[2] - 2.0);
            observed.minimised[0].push((x - 0.3).powi(2) + (x - 0.8).powi(2) * u * u + y);
            observed.excess[0].push(u / 5.0 + 0.5 - y);
            observed.points.push(point);
        };
        for mut point in space_filling(0..first_tests(3), 3, seed) {
            point[2] = normal(point[2]);
            test(&mut observed, point);
        }
        while observed.points.len() < size
            && let Some(points) = observed.proposals(&[], BATCH, seed)
        {
            points
                .into_iter()
                .for_each(|point| test(&mut observed, point));
        }
        observed
    }

    #[test]
    fn verify_robust_optima_of_a_bowl_with_a_scattering_side() {
        // The mean is least at x = (0.3 + 0.8) / 2, the 90th percentile at (0.3 + 0.8 q) / (1 + q), where q is that of u^2;
        // the nominal optimum is x = 0.3. The limit needs y = 0.5 + 1.645 / 5.
        let q = normal_quantile(0.95).powi(2);
        let y = 0.5 + normal_quantile(0.95) / 5.0;
        for (share, x, scale) in [
            (None, 0.55, 1.0),
            (Some(0.9), (0.3 + 0.8 * q) / (1.0 + q), q),
        ] {
            let exact = (x - 0.3_f64).powi(2) + scale * (x - 0.8_f64).powi(2) + y;
            for seed in 1..=3 {
                let observed = searched(share, 60, seed);
                let found = observed.comparison(0).unwrap();
                let design = observed.design(found.optimum.row);
                println!(
                    "{} tests: {design:.3?} of {x:.3} {y:.3}",
                    observed.points.len()
                );
                assert!(
                    (design[0] - x).abs() < 0.02 && (design[1] - y).abs() < 0.02,
                    "{design:?}"
                );
                // Under u the first design is worse where its part of y is less than what its x costs.
                let output = |design: &[f64], u: f64| {
                    (design[0] - 0.3).powi(2) + (design[0] - 0.8).powi(2) * u * u + design[1]
                };
                let nodes = (0..20_000).map(|node| (f64::from(node) + 0.5) / 20_000.0);
                let better = |u: &f64| output(design, *u) < output(observed.design(0), *u);
                let better = nodes.map(normal_quantile).filter(better).count();
                for (estimate, exact) in [
                    (found.optimum.statistic, exact),
                    (found.optimum.kept[0], normal_share(5.0 * (design[1] - 0.5))),
                    (found.beats, better as f64 / 20_000.0),
                ] {
                    println!("    {estimate:.3?} of {exact:.3}");
                    let [low, high] = estimate.interval;
                    assert!(low <= exact && exact <= high, "{estimate:?} of {exact}");
                }
            }
        }
    }
}
