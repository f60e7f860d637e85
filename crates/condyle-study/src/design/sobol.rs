//! Points of Sobol, scrambled.

use crate::{
    chance::{Numbers, mixed},
    distribution::Place,
};

/// Axes that there are directions for, the first among them.
pub(crate) const MAX_AXES: usize = DIRECTIONS.len() + 1;
const BITS: usize = 32;

/// Where point `row` lies along each of `axes`: the points of Sobol with the directions of Joe and Kuo (2008), every axis
/// scrambled by Owen's method (1995) with the chance of `seed`. Of the first 2^m points one lies in each of as many equal
/// slices of every axis.
pub(crate) fn sobol_places(row: u64, axes: usize, seed: u64) -> Vec<Place> {
    let place = |axis: usize| {
        let scrambled = scrambled(point(row, axis), Numbers::of_one(seed, axis as u64).next());
        Place::Share((f64::from(scrambled) + 0.5) / (1_u64 << BITS) as f64)
    };
    (0..axes).map(place).collect()
}

/// Point `row` along `axis` as a binary fraction.
fn point(row: u64, axis: usize) -> u32 {
    let directions = directions(axis);
    let is_set = |bit: &usize| row >> bit & 1 == 1;
    let set = (0..BITS).filter(is_set);
    set.fold(0, |point, bit| point ^ directions[bit])
}

/// The directions of an axis, by the recurrence of its primitive polynomial (Bratley and Fox 1988).
fn directions(axis: usize) -> [u32; BITS] {
    let mut directions = std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
    let Some((polynomial, first)) = axis.checked_sub(1).map(|row| DIRECTIONS[row]) else {
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

/// Owen's nested uniform scrambling: every bit is turned or not by chance that the bits above it choose.
fn scrambled(point: u32, seed: u64) -> u32 {
    (0..BITS).fold(0, |sum, bit| {
        let above = u64::from(point)
            .checked_shr((BITS - bit) as u32)
            .unwrap_or_default();
        let chance = mixed(seed ^ mixed((above << 6 | bit as u64).wrapping_add(1)));
        let turned = (point >> (BITS - 1 - bit) & 1) ^ (chance >> 63) as u32;
        sum | turned << (BITS - 1 - bit)
    })
}

/// Of every axis but the first: the inner coefficients of its primitive polynomial, the highest power first, and the odd
/// numbers that its first directions begin with. From new-joe-kuo-6.21201 of Joe and Kuo (2008), as scipy 1.17.1 has them.
pub(crate) const DIRECTIONS: &[(u32, &[u32])] = &[
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
    (50, &[1, 3, 1, 3, 5, 53, 69]),
    (55, &[1, 1, 5, 5, 23, 33, 13]),
    (56, &[1, 1, 7, 7, 1, 61, 123]),
    (59, &[1, 1, 7, 9, 13, 61, 49]),
    (62, &[1, 3, 3, 5, 3, 55, 33]),
    (14, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (21, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (22, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (38, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (47, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (49, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (50, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (52, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (56, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (67, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (70, &[1, 3, 7, 11, 15, 39, 119, 27]),
    (84, &[1, 1, 3, 1, 11, 31, 97, 225]),
    (97, &[1, 1, 1, 3, 23, 43, 57, 177]),
    (103, &[1, 3, 7, 7, 17, 17, 37, 71]),
    (115, &[1, 3, 1, 5, 27, 63, 123, 213]),
    (122, &[1, 1, 3, 5, 11, 43, 53, 133]),
    (8, &[1, 3, 5, 5, 29, 17, 47, 173, 479]),
    (13, &[1, 3, 3, 11, 3, 1, 109, 9, 69]),
    (16, &[1, 1, 1, 5, 17, 39, 23, 5, 343]),
    (22, &[1, 3, 1, 5, 25, 15, 31, 103, 499]),
    (25, &[1, 1, 1, 11, 11, 17, 63, 105, 183]),
    (44, &[1, 1, 5, 11, 9, 29, 97, 231, 363]),
    (47, &[1, 1, 5, 15, 19, 45, 41, 7, 383]),
    (52, &[1, 3, 7, 7, 31, 19, 83, 137, 221]),
    (55, &[1, 1, 1, 3, 23, 15, 111, 223, 83]),
    (59, &[1, 1, 5, 13, 31, 15, 55, 25, 161]),
    (62, &[1, 1, 3, 13, 25, 47, 39, 87, 257]),
];

#[cfg(test)]
mod tests {
    use super::*;

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
