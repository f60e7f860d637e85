//! Sobol indices.

use condyle_case::study::Design;
use serde::Serialize;

use crate::{
    answers::{
        data::Data,
        words::{label, within_design},
    },
    random::Random,
    statistics::{central_interval, mean},
};

/// Number of bootstrap samples of the base points.
const RESAMPLES: u64 = 500;
/// Seed of these samples, which makes the intervals reproducible.
const SEED: u64 = 20_080_101;

/// The parts of the variance of an output that an input explains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Indices {
    pub output: &'static str,
    /// The name of the design, if the study compares designs.
    pub design: Option<String>,
    pub input: String,
    /// By the input alone.
    pub first: f64,
    /// The 95 % interval, by bootstrap or from the emulator.
    pub first_interval: [f64; 2],
    /// Total index: the input with its interactions.
    pub total: f64,
    pub total_interval: [f64; 2],
    /// Bases with all tests done, or tests of the emulator.
    pub bases: usize,
}

impl Indices {
    /// Returns the output in words, with the design if there are several.
    pub fn title(&self) -> String {
        within_design(&label(self.output), self.design.as_deref())
    }

    /// Returns the first index in words. It cannot exceed the total one, except by the scatter of both.
    pub fn first_in_words(&self) -> String {
        in_words(self.first, self.first_interval, self.total)
    }

    /// Returns the total index in words. It cannot exceed 1, except by its scatter.
    pub fn total_in_words(&self) -> String {
        in_words(self.total, self.total_interval, 1.0)
    }
}

/// Returns those of the indices whose first index is positive, and the sum of these with the ends of its 95 % interval, from their
/// intervals as if they were independent.
pub(crate) fn sum_of_first<'a>(all: &[&'a Indices]) -> (Vec<&'a Indices>, [f64; 3]) {
    let positive: Vec<&Indices> = all.iter().copied().filter(|one| one.first > 0.0).collect();
    let sum: f64 = positive.iter().map(|one| one.first).sum();
    let half = |end: usize| {
        let halves = positive
            .iter()
            .map(|one| one.first_interval[end] - one.first);
        halves.map(|half| half * half).sum::<f64>().sqrt()
    };
    let ends = [sum, sum - half(0), sum + half(1)];
    (positive, ends)
}

fn in_words(index: f64, [low, _]: [f64; 2], most: f64) -> String {
    let [index, shown_most] = [index, most].map(|index| format!("{index:.3}"));
    // The interval explains a smaller excess, and rounding one that is not shown.
    let is_noise = low > most && index != shown_most;
    let noise = if is_noise { " (noise)" } else { "" };
    format!("{index}{noise}")
}

/// Returns the indices of a Saltelli design; empty for other designs, and of outputs with fewer than two bases.
pub(crate) fn indices(data: &Data<'_>) -> Vec<Indices> {
    let study = data.plan.study();
    if !matches!(study.design, Design::Saltelli(_)) {
        return Vec::new();
    }
    let keys: Vec<&str> = study
        .inputs
        .iter()
        .map(|input| input.key.as_str())
        .collect();
    let outputs = data.outputs.iter();
    outputs
        .flat_map(|(output, values)| of_output(output.key, &keys, values))
        .collect()
}

fn of_output(output: &'static str, inputs: &[&str], values: &[f64]) -> Vec<Indices> {
    let bases = bases(inputs.len(), values);
    let count = bases.len();
    // A single base has no scatter, and none has no index.
    if count < 2 {
        return Vec::new();
    }
    // A bootstrap sample: as many bases, with replacement.
    let resample = |number| {
        let mut numbers = Random::stream(SEED, number);
        (0..count).map(|_| &bases[numbers.index(count)]).collect()
    };
    let all: Vec<&Vec<f64>> = bases.iter().collect();
    let resamples: Vec<Vec<&Vec<f64>>> = (0..RESAMPLES).map(resample).collect();
    let index = |(place, input): (usize, &&str)| {
        let (first, total) = index_of(place, &all);
        let samples = resamples.iter().map(|sample| index_of(place, sample));
        let (firsts, totals) = samples.unzip();
        Indices {
            output,
            design: None,
            input: (*input).to_owned(),
            first,
            first_interval: central_interval(firsts),
            total,
            total_interval: central_interval(totals),
            bases: count,
        }
    };
    inputs.iter().enumerate().map(index).collect()
}

/// Returns the outputs of every base (A, A with each input from B, B) with all tests done, minus the mean of all, which reduces the
/// scatter of the estimate of the first index.
fn bases(inputs: usize, values: &[f64]) -> Vec<Vec<f64>> {
    let whole = values.chunks_exact(inputs + 2);
    let whole = whole.filter(|base| base.iter().all(|value| value.is_finite()));
    let mut whole: Vec<Vec<f64>> = whole.map(<[f64]>::to_vec).collect();
    let both = whole.iter().flat_map(|base| [base[0], base[inputs + 1]]);
    let mean = mean(&both.collect::<Vec<f64>>());
    whole.iter_mut().flatten().for_each(|value| *value -= mean);
    whole
}

/// Returns the first and total index of an input from some bases: S = mean(b (c - a)) / V (Saltelli et al. 2010),
/// T = mean((a - c)^2) / 2 V (Jansen 1999).
fn index_of(input: usize, bases: &[&Vec<f64>]) -> (f64, f64) {
    let count = bases.len() as f64;
    let [mut sum, mut squares, mut first, mut total] = [0.0; 4];
    for base in bases {
        let (a, c, b) = (base[0], base[input + 1], base[base.len() - 1]);
        sum += a + b;
        squares += a * a + b * b;
        first += b * (c - a);
        total += (a - c).powi(2);
    }
    let variance = squares / (2.0 * count) - (sum / (2.0 * count)).powi(2);
    // A constant output has no variance to divide by; no input explains any of it.
    if variance <= 0.0 {
        return (0.0, 0.0);
    }
    (first / count / variance, total / (2.0 * count) / variance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    use crate::{design::Saltelli, distribution::Place};

    fn found(inputs: usize, bases: u64, of: impl Fn(&[f64]) -> f64) -> Vec<Indices> {
        let value = |row| {
            let places = Saltelli::places(row, inputs, 1);
            let shares = places.into_iter().map(|place| match place {
                Place::Share(share) => share,
                _ => f64::NAN,
            });
            of(&shares.collect::<Vec<f64>>())
        };
        let values: Vec<f64> = (0..bases * (inputs as u64 + 2)).map(value).collect();
        of_output("y", &vec!["x"; inputs], &values)
    }

    #[test]
    fn verify_indices_of_ishigami() {
        let (a, b) = (7.0, 0.1);
        let found = found(3, 16_384, |shares| {
            let x: Vec<f64> = shares
                .iter()
                .map(|share| PI * (2.0 * share - 1.0))
                .collect();
            x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin()
        });
        let pi4 = PI.powi(4);
        let first = [(1.0 + b * pi4 / 5.0).powi(2) / 2.0, a * a / 8.0, 0.0];
        let both = b * b * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
        let variance = first.iter().sum::<f64>() + both;
        let total = [first[0] + both, first[1], both];
        for (input, found) in found.iter().enumerate() {
            let (first, total) = (first[input] / variance, total[input] / variance);
            assert!((found.first - first).abs() < 0.01, "{found:?} {first}");
            assert!((found.total - total).abs() < 0.01, "{found:?} {total}");
            let [low, high] = found.total_interval;
            assert!(
                low <= total + 0.005 && total - 0.005 <= high,
                "{found:?} {total}"
            );
        }
    }

    #[test]
    fn verify_the_sum_of_two_indices_has_an_interval_and_no_negative_part() {
        let index = |first, first_interval| Indices {
            output: "mass_loss_mg",
            design: None,
            input: "x".to_owned(),
            first,
            first_interval,
            total: first,
            total_interval: first_interval,
            bases: 32,
        };
        // Bootstrap samples of both together give 0.57 to 1.43.
        let both = [index(0.833, [0.474, 1.213]), index(0.174, [-0.036, 0.384])];
        let (_, ends) = sum_of_first(&both.each_ref());
        for (end, exact) in ends.into_iter().zip([1.007, 0.5911, 1.4412]) {
            assert!((end - exact).abs() < 1e-4, "{ends:?}");
        }
        let negative = [index(0.808, [0.251, 1.523]), index(-0.072, [-0.565, 0.269])];
        let (named, ends) = sum_of_first(&negative.each_ref());
        assert_eq!((named.len(), ends[0]), (1, 0.808));
    }

    #[test]
    fn outputs_without_two_bases_have_no_indices() {
        let solved = |bases: u64| {
            let of = |row: u64| {
                if row < bases * 4 {
                    row as f64
                } else {
                    f64::NAN
                }
            };
            let values: Vec<f64> = (0..16).map(of).collect();
            of_output("y", &["a", "b"], &values).len()
        };
        assert_eq!([0, 1, 2].map(solved), [0, 0, 2]);
    }

    #[test]
    fn verify_indices_of_the_g_function() {
        let weights: [f64; 6] = [0.0, 0.5, 3.0, 9.0, 99.0, 99.0];
        let found = found(6, 4096, |shares| {
            let factor = |(x, a): (&f64, &f64)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a);
            shares.iter().zip(&weights).map(factor).product()
        });
        let own = weights.map(|a| 1.0 / (3.0 * (1.0 + a).powi(2)));
        let variance = own.iter().map(|own| 1.0 + own).product::<f64>() - 1.0;
        for (input, found) in found.iter().enumerate() {
            let others: f64 = own.iter().map(|own| 1.0 + own).product::<f64>() / (1.0 + own[input]);
            let (first, total) = (own[input] / variance, own[input] * others / variance);
            assert!((found.first - first).abs() < 0.01, "{found:?} {first}");
            assert!((found.total - total).abs() < 0.01, "{found:?} {total}");
        }
    }

    #[test]
    fn bases_with_a_test_that_failed_are_left_out() {
        let mut values = vec![1.0, 2.0, 3.0, 4.0, 2.0, 5.0, 1.0, 3.0, 0.0];
        assert_eq!(of_output("y", &["x"], &values)[0].bases, 3);
        values[4] = f64::NAN;
        assert_eq!(of_output("y", &["x"], &values)[0].bases, 2);
    }
}
