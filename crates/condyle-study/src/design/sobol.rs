//! Scrambled Sobol points.

use std::sync::LazyLock;

use crate::{
    distribution::Place,
    random::{Random, mixed},
};

/// The number of axes with known directions.
pub(crate) const MAX_AXES: usize = 64;
const BITS: usize = 32;

/// Returns the coordinates of Sobol point `row`, with the directions of Joe and Kuo (2008), every axis scrambled
/// independently by Owen's method (1995). Of the first 2^m points one lies in each of as many equal slices of every
/// axis.
pub(crate) fn sobol_shares(row: u64, axes: usize, seed: u64) -> impl Iterator<Item = f64> {
    (0..axes).map(move |axis| {
        let scrambled = scrambled(point(row, axis), Random::stream(seed, axis as u64).next());
        // The middle of its interval: neither 0 nor 1, whose quantiles may be infinite.
        (f64::from(scrambled) + 0.5) / (1_u64 << BITS) as f64
    })
}

/// Returns these coordinates as places in the distributions of inputs.
pub(crate) fn sobol_places(row: u64, axes: usize, seed: u64) -> Vec<Place> {
    sobol_shares(row, axes, seed).map(Place::Share).collect()
}

/// Returns point `row` along `axis` as a binary fraction.
fn point(row: u64, axis: usize) -> u32 {
    let directions = directions(axis);
    let set = (0..BITS).filter(|bit| row >> bit & 1 == 1);
    set.fold(0, |point, bit| point ^ directions[bit])
}

/// Returns the directions of an axis, by the recurrence of its primitive polynomial (Bratley and Fox 1988).
fn directions(axis: usize) -> [u32; BITS] {
    let mut directions = std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
    let Some((polynomial, first)) = axis.checked_sub(1).map(|row| &DIRECTIONS[row]) else {
        return directions;
    };
    let degree = first.len();
    for bit in 0..BITS {
        directions[bit] = if bit < degree {
            first[bit] << (BITS - 1 - bit)
        } else {
            let above = directions[bit - degree];
            let inner = (1..degree).filter(|term| polynomial >> (degree - 1 - term) & 1 == 1);
            inner.fold(above ^ (above >> degree), |sum, term| {
                sum ^ directions[bit - term]
            })
        };
    }
    directions
}

/// Owen's nested uniform scrambling: each bit is flipped or not by a random bit that depends on the bits above it.
fn scrambled(point: u32, seed: u64) -> u32 {
    (0..BITS).fold(0, |sum, bit| {
        let above = u64::from(point)
            .checked_shr((BITS - bit) as u32)
            .unwrap_or_default();
        let random = mixed(seed ^ mixed((above << 6 | bit as u64).wrapping_add(1)));
        let flipped = (point >> (BITS - 1 - bit) & 1) ^ (random >> 63) as u32;
        sum | flipped << (BITS - 1 - bit)
    })
}

/// For every axis but the first, the inner coefficients of its primitive polynomial, the highest power first, and the odd
/// numbers of its first directions: new-joe-kuo-6.21201 of Joe and Kuo (2008), as distributed with scipy 1.17.1.
static DIRECTIONS: LazyLock<Vec<(u32, Vec<u32>)>> = LazyLock::new(|| {
    let axis = |line: &str| {
        let mut numbers = line.split(' ').filter_map(|number| number.parse().ok());
        Some((numbers.next()?, numbers.collect()))
    };
    include_str!("joe-kuo.txt")
        .lines()
        .filter_map(axis)
        .collect()
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_has_directions() {
        assert_eq!(DIRECTIONS.len() + 1, MAX_AXES);
    }

    #[test]
    fn cross_points_are_those_of_scipy() {
        // scipy.stats.qmc.Sobol(6, scramble=False) goes by Gray code: its points 1, 2 and 6.
        let coordinate = |row, axis| f64::from(point(row, axis)) / 2f64.powi(32);
        let first: Vec<f64> = (0..6).map(|axis| coordinate(1, axis)).collect();
        assert_eq!(first, [0.5; 6]);
        let third: Vec<f64> = (0..6).map(|axis| coordinate(3, axis)).collect();
        assert_eq!(third, [0.75, 0.25, 0.25, 0.25, 0.75, 0.75]);
        let fifth: Vec<f64> = (0..6).map(|axis| coordinate(5, axis)).collect();
        assert_eq!(fifth, [0.625, 0.125, 0.875, 0.625, 0.625, 0.875]);
    }

    #[test]
    fn verify_every_axis_has_one_point_in_each_slice_before_and_after_scrambling() {
        for axis in 0..MAX_AXES {
            for log_count in [1, 4, 9] {
                let count = 1_u64 << log_count;
                for seed in [None, Some(1), Some(2)] {
                    let slice = |row| {
                        let point = point(row, axis);
                        let point = seed.map_or(point, |seed| scrambled(point, seed));
                        point >> (32 - log_count)
                    };
                    let mut slices: Vec<u32> = (0..count).map(slice).collect();
                    slices.sort_unstable();
                    assert!(slices.iter().copied().eq(0..count as u32), "axis {axis}");
                }
            }
        }
    }

    #[test]
    fn verify_pairs_of_axes_fill_the_square_evenly() {
        // The first axes are a (0, m, 2)-net: each of 16 x 16 boxes has one of 256 points.
        let mut boxes: Vec<(u32, u32)> = (0..256)
            .map(|row| [0, 1].map(|axis| scrambled(point(row, axis), axis as u64) >> 28))
            .map(|[x, y]| (x, y))
            .collect();
        boxes.sort_unstable();
        boxes.dedup();
        assert_eq!(boxes.len(), 256);
    }
}
