//! A Latin hypercube, test by test.

use super::super::super::chance::Numbers;
use super::permutation::Permutation;
use super::place::Place;

/// Where test `row` of `tests` has its inputs: along each, one test lies in each of as many equal slices (McKay, Beckman
/// and Conover 1979).
pub(in super::super) fn latin_places(row: u64, tests: u64, inputs: usize, seed: u64) -> Vec<Place> {
    let place = |input: usize| {
        let mut numbers = Numbers::of_one(seed, input as u64);
        let slice = Permutation::new(tests, &mut numbers).at(row);
        let within = Numbers::of_one(numbers.next(), row).share();
        Place::Share((slice as f64 + within) / tests as f64)
    };
    (0..inputs).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for (tests, inputs, seed) in [(1, 3, 7), (10, 1, 0), (200, 12, 1)] {
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
}
