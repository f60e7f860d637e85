//! Designs: the places of the inputs in every test, each computed from the number of the test alone.

pub(crate) mod sobol;

use condyle_case::study::Correlation;
use nalgebra::DMatrix;

use crate::{
    design::sobol::sobol_places,
    distribution::{Place, normal_quantile, normal_share},
    random::{Random, mixed},
};

/// Returns the places of test `row` of a factorial design: every combination of values, `counts[i]` of input `i`; the
/// last input changes fastest.
pub(crate) fn factorial_places(row: u64, counts: &[u64]) -> Vec<Place> {
    let mut rest = row;
    let mut places: Vec<Place> = Vec::with_capacity(counts.len());
    for &count in counts.iter().rev() {
        places.push(along(rest % count, count));
        rest /= count;
    }
    places.reverse();
    places
}

/// Returns the places of test `row` of a one-at-a-time design: first all inputs as in the case, then each input in
/// turn at its values.
pub(crate) fn one_at_a_time_places(row: u64, counts: &[u64]) -> Vec<Place> {
    let mut places = vec![Place::OfCase; counts.len()];
    let Some(mut rest) = row.checked_sub(1) else {
        return places;
    };
    for (place, &count) in places.iter_mut().zip(counts) {
        if rest < count {
            *place = along(rest, count);
            break;
        }
        rest -= count;
    }
    places
}

/// Returns the value `number` of `count` evenly spaced ones.
fn along(number: u64, count: u64) -> Place {
    // A single value lies at the low end.
    Place::Along(number as f64 / (count - 1).max(1) as f64)
}

/// Returns the places of test `row` of a Latin hypercube: for each input, one test lies in each of `tests` slices of
/// equal probability (McKay, Beckman and Conover 1979). Hypercubes are nested: the tests of one are the first tests of that of
/// twice the size, whose other tests lie in the empty halves of its slices (Qian 2009).
pub(crate) fn latin_places(row: u64, tests: u64, inputs: usize, seed: u64) -> Vec<Place> {
    let smallest = tests >> tests.trailing_zeros();
    let place = |input: usize| {
        let seed = Random::stream(seed, input as u64).next();
        Place::Share(latin_share(row, smallest, seed))
    };
    (0..inputs).map(place).collect()
}

/// Number of slices, at least as many as there can be tests, within which a place is random.
const MAX_SLICES: u64 = 1 << 30;

/// Returns the place of test `row` for one input, where the smallest of the nested hypercubes has `smallest` slices.
///
/// Slices are halved again and again. A random bit of each slice states which half the first test in it takes; the second one
/// joins with the next larger hypercube and takes the other half.
fn latin_share(row: u64, smallest: u64, seed: u64) -> f64 {
    let joins = (row / smallest)
        .checked_ilog2()
        .map_or(0, |level| level + 1);
    let mut numbers = Random::stream(seed, u64::from(joins));
    let (mut slices, mut slice) = if joins == 0 {
        (smallest, Permutation::new(smallest, &mut numbers).at(row))
    } else {
        let before = smallest << (joins - 1);
        let halved = Permutation::new(before, &mut numbers).at(row - before);
        let empty = 1 - first_half(before, halved, seed);
        (2 * before, 2 * halved + empty)
    };
    while slices < MAX_SLICES {
        slice = 2 * slice + first_half(slices, slice, seed);
        slices *= 2;
    }
    let within = Random::stream(!seed, row).share();
    (slice as f64 + within) / slices as f64
}

/// Returns the half, 0 or 1, of one of `slices` that the first test in it takes.
fn first_half(slices: u64, slice: u64, seed: u64) -> u64 {
    mixed(seed ^ mixed(slices + slice)) >> 63
}

/// Rounds of the network: four suffice with good rounds (Luby and Rackoff 1988), and these are simple ones.
const ROUNDS: usize = 6;

/// A random permutation of the numbers below a count, each computed without the others.
///
/// A Feistel network permutes the numbers of an even count of bits whatever its rounds are; a result beyond the count is
/// permuted again until it lies below (cycle walking).
pub(crate) struct Permutation {
    count: u64,
    half_bits: u32,
    keys: [u64; ROUNDS],
}

impl Permutation {
    pub fn new(count: u64, numbers: &mut Random) -> Self {
        // The smallest even number of bits that holds the count: fewer than four numbers per result are permuted again.
        let bits = u64::BITS - (count.max(2) - 1).leading_zeros();
        Self {
            count,
            half_bits: bits.div_ceil(2),
            keys: std::array::from_fn(|_| numbers.next()),
        }
    }

    /// Returns the number at `place` below the count.
    pub fn at(&self, place: u64) -> u64 {
        let mut found = self.permuted(place);
        while found >= self.count {
            found = self.permuted(found);
        }
        found
    }

    fn permuted(&self, value: u64) -> u64 {
        let mask = (1 << self.half_bits) - 1;
        let halves = (value >> self.half_bits, value & mask);
        let (left, right) = self.keys.iter().fold(halves, |(left, right), key| {
            (right, left ^ (mixed(right ^ key) & mask))
        });
        (left << self.half_bits) | right
    }
}

/// A Gaussian copula: correlates independent inputs by replacing their normal scores z by L z, where L L^T is the matrix
/// of correlations.
pub(crate) struct Copula(DMatrix<f64>);

impl Copula {
    /// Creates the copula, or returns `None` if the matrix of correlations is not positive definite.
    pub fn new(inputs: usize, correlations: &[Correlation]) -> Option<Self> {
        let mut matrix = DMatrix::identity(inputs, inputs);
        for correlation in correlations {
            let [one, other] = correlation.inputs;
            matrix[(one, other)] = correlation.coefficient;
            matrix[(other, one)] = correlation.coefficient;
        }
        Some(Self(matrix.cholesky()?.unpack()))
    }

    /// Correlates places. An input without a correlation keeps its place to the last bit.
    pub fn apply(&self, places: &mut [Place]) {
        let score = |place: &Place| match place {
            Place::Share(share) => normal_quantile(*share),
            Place::OfCase | Place::Along(_) => 0.0,
        };
        let independent = places.to_vec();
        for (row, place) in places.iter_mut().enumerate() {
            let before = self.0.row(row);
            if before.iter().take(row).any(|factor| *factor != 0.0) {
                let scores = before.iter().zip(&independent);
                let sum = scores.map(|(factor, place)| factor * score(place)).sum();
                *place = Place::Share(normal_share(sum));
            }
        }
    }
}

/// A walk: from a random point of a grid, every input steps once, in random order (Morris 1991).
pub(crate) struct Walk {
    start: Vec<f64>,
    steps: Vec<f64>,
    order: Vec<usize>,
}

impl Walk {
    /// Creates walk `number` over an even number of `levels` of each input. A step covers levels / (2 (levels - 1))
    /// of the range, so that all levels are equally likely.
    pub fn new(number: u64, inputs: usize, levels: u64, seed: u64) -> Self {
        let mut numbers = Random::stream(seed, number);
        let (half, last) = (levels / 2, (levels - 1) as f64);
        let mut start = Vec::with_capacity(inputs);
        let mut steps = Vec::with_capacity(inputs);
        for _ in 0..inputs {
            let low = numbers.index(half as usize) as f64;
            let is_up = numbers.share() < 0.5;
            let step = half as f64 / last;
            start.push(if is_up { low / last } else { low / last + step });
            steps.push(if is_up { step } else { -step });
        }
        let mut order: Vec<usize> = (0..inputs).collect();
        numbers.shuffle(&mut order);
        Self {
            start,
            steps,
            order,
        }
    }

    /// Returns the input that steps from test `step` of the walk to the next, and its signed step.
    pub fn step(&self, step: usize) -> (usize, f64) {
        let input = self.order[step];
        (input, self.steps[input])
    }

    fn at(&self, step: usize) -> Vec<Place> {
        let mut parts = self.start.clone();
        for &input in &self.order[..step] {
            parts[input] += self.steps[input];
        }
        parts
            .into_iter()
            .map(|part| Place::Along(part.clamp(0.0, 1.0)))
            .collect()
    }
}

/// Returns the places of test `row` in the walks of Morris, each of which has one test more than there are inputs.
pub(crate) fn morris_places(row: u64, inputs: usize, levels: u64, seed: u64) -> Vec<Place> {
    let tests = inputs as u64 + 1;
    Walk::new(row / tests, inputs, levels, seed).at((row % tests) as usize)
}

/// A test of a Saltelli design: every base is two points A and B, and A again with each input from B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Saltelli {
    A,
    /// A with this input from B.
    Changed(usize),
    B,
}

impl Saltelli {
    /// Returns the number of the base of a row, and the test of that base.
    pub fn of(row: u64, inputs: usize) -> (u64, Self) {
        let tests = inputs as u64 + 2;
        let test = match (row % tests) as usize {
            0 => Self::A,
            place if place <= inputs => Self::Changed(place - 1),
            _ => Self::B,
        };
        (row / tests, test)
    }

    /// Returns the places of the inputs (Saltelli et al. 2010): A and B are the halves of one Sobol point of twice
    /// the dimension, which keeps them independent.
    pub fn places(row: u64, inputs: usize, seed: u64) -> Vec<Place> {
        let (base, test) = Self::of(row, inputs);
        let both = sobol_places(base, 2 * inputs, seed);
        let (a, b) = both.split_at(inputs);
        match test {
            Self::A => a.to_vec(),
            Self::B => b.to_vec(),
            Self::Changed(input) => {
                let mut changed = a.to_vec();
                changed[input] = b[input];
                changed
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Place::{Along, OfCase};

    #[test]
    fn every_value_meets_every_other() {
        let all: Vec<Vec<Place>> = (0..6).map(|row| factorial_places(row, &[2, 3])).collect();
        assert_eq!(all[0], [Along(0.0), Along(0.0)]);
        assert_eq!(all[1], [Along(0.0), Along(0.5)]);
        assert_eq!(all[5], [Along(1.0), Along(1.0)]);
    }

    #[test]
    fn one_moves_and_the_others_stay() {
        let all: Vec<Vec<Place>> = (0..6)
            .map(|row| one_at_a_time_places(row, &[2, 3]))
            .collect();
        assert_eq!(all[0], [OfCase, OfCase]);
        assert_eq!(all[2], [Along(1.0), OfCase]);
        assert_eq!(all[4], [OfCase, Along(0.5)]);
    }

    fn shares(tests: u64, inputs: usize, seed: u64) -> Vec<Vec<f64>> {
        let share = |place: Place| match place {
            Place::Share(share) => share,
            _ => panic!("a Latin hypercube has shares"),
        };
        let row = |row| {
            latin_places(row, tests, inputs, seed)
                .into_iter()
                .map(share)
                .collect()
        };
        (0..tests).map(row).collect()
    }

    #[test]
    fn verify_every_slice_of_every_input_has_one_test() {
        for (tests, inputs, seed) in [(1, 3, 7), (10, 1, 0), (200, 12, 1), (64, 3, 2), (75, 2, 3)] {
            let all = shares(tests, inputs, seed);
            for input in 0..inputs {
                let slice = |row: &Vec<f64>| (row[input] * tests as f64) as u64;
                let mut slices: Vec<u64> = all.iter().map(slice).collect();
                slices.sort_unstable();
                assert_eq!(slices, (0..tests).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn verify_a_hypercube_of_twice_the_size_begins_with_the_same_tests() {
        for (tests, larger) in [(25, 50), (50, 200), (1, 64), (96, 384)] {
            let all = shares(larger, 3, 5);
            assert_eq!(shares(tests, 3, 5), all[..tests as usize]);
        }
    }

    #[test]
    fn inputs_and_seeds_know_nothing_of_each_other() {
        let correlation = |one: &[f64], other: &[f64]| {
            let products = one.iter().zip(other).map(|(a, b)| (a - 0.5) * (b - 0.5));
            12.0 * products.sum::<f64>() / one.len() as f64
        };
        let column = |seed, input: usize| -> Vec<f64> {
            shares(2000, 3, seed).iter().map(|row| row[input]).collect()
        };
        let (a, b, c) = (column(1, 0), column(1, 1), column(2, 0));
        // Three standard deviations of a correlation of 2000 points.
        let most = 3.0 / 2000_f64.sqrt();
        assert!(correlation(&a, &b).abs() < most && correlation(&a, &c).abs() < most);
        let (even, odd): (Vec<f64>, Vec<f64>) = a.chunks(2).map(|pair| (pair[0], pair[1])).unzip();
        assert!(correlation(&even, &odd).abs() < 3.0 / 1000_f64.sqrt());
    }

    #[test]
    fn verify_every_number_comes_once() {
        for count in [1, 2, 3, 10, 100, 4097] {
            let order = Permutation::new(count, &mut Random::stream(count, 0));
            let mut all: Vec<u64> = (0..count).map(|place| order.at(place)).collect();
            all.sort_unstable();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    fn of(coefficient: f64) -> Correlation {
        Correlation {
            inputs: [0, 2],
            coefficient,
        }
    }

    #[test]
    fn verify_scores_have_the_correlation_and_others_stay() {
        let correlated = Copula::new(3, &[of(0.8)]).unwrap();
        let mut sum = 0.0;
        let count = 4096;
        for row in 0..count {
            let mut places = sobol_places(row, 3, 1);
            let before = places.clone();
            correlated.apply(&mut places);
            assert_eq!(before[..2], places[..2]);
            let score = |place: Place| match place {
                Place::Share(share) => normal_quantile(share),
                _ => f64::NAN,
            };
            sum += score(places[0]) * score(places[2]);
        }
        let found = sum / count as f64;
        assert!((found - 0.8).abs() < 0.01, "{found}");
    }

    #[test]
    fn contradictions_are_found() {
        let pair = |inputs, coefficient| Correlation {
            inputs,
            coefficient,
        };
        let all = [pair([0, 1], 0.9), pair([1, 2], 0.9), pair([0, 2], -0.9)];
        assert!(Copula::new(3, &all).is_none());
    }

    #[test]
    fn verify_one_input_steps_at_a_time_and_stays_on_the_grid() {
        let (inputs, levels) = (5, 4);
        for walk in 0..20 {
            let rows: Vec<Vec<Place>> = (0..6)
                .map(|step| morris_places(walk * 6 + step, inputs, levels, 3))
                .collect();
            for (step, pair) in rows.windows(2).enumerate() {
                let moved: Vec<usize> =
                    (0..inputs).filter(|i| pair[0][*i] != pair[1][*i]).collect();
                let known = Walk::new(walk, inputs, levels, 3).step(step);
                assert_eq!(moved, [known.0]);
                assert!((known.1.abs() - 2.0 / 3.0).abs() < 1e-12);
            }
            let on_grid = |place: &Place| match place {
                Along(part) => (part * 3.0 - (part * 3.0).round()).abs() < 1e-12,
                _ => false,
            };
            assert!(rows.iter().flatten().all(on_grid));
        }
    }
}
