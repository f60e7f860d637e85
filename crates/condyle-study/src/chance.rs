//! Numbers of chance that a seed means the same for ever, on any machine.

/// The numbers of a seed: SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Numbers(u64);

/// What is added from one number to the next: 2^64 over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

impl Numbers {
    pub fn of(seed: u64) -> Self {
        Self(seed)
    }

    /// Those of one of many things that a seed has, each with numbers of its own.
    pub fn of_one(seed: u64, which: u64) -> Self {
        Self(mixed(seed.wrapping_add(STEP)) ^ mixed(which.wrapping_add(STEP).wrapping_mul(STEP)))
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mixed(self.0)
    }

    /// Between 0 and 1, neither of them.
    pub fn share(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// One of `count` places.
    pub fn place(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }

    /// Puts values into an order of chance (Fisher and Yates).
    pub fn shuffle(&mut self, values: &mut [usize]) {
        for last in (1..values.len()).rev() {
            let other = self.place(last + 1);
            values.swap(last, other);
        }
    }
}

/// The bits of a number mixed so that each depends on all.
pub(crate) fn mixed(value: u64) -> u64 {
    let mixed = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

/// `points` in the unit cube of `axes` dimensions: along each axis, one lies in each of as many equal slices
/// (McKay, Beckman and Conover 1979). The same seed gives the same points.
pub(crate) fn latin_hypercube(points: usize, axes: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut numbers = Numbers::of(seed);
    let mut all = vec![vec![0.0; axes]; points];
    for axis in 0..axes {
        let mut slices: Vec<usize> = (0..points).collect();
        numbers.shuffle(&mut slices);
        for (point, slice) in all.iter_mut().zip(slices) {
            point[axis] = (slice as f64 + numbers.share()) / points as f64;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_every_slice_of_every_axis_has_one_point() {
        for (points, axes, seed) in [(1, 3, 7), (10, 1, 0), (200, 12, 1)] {
            let all = latin_hypercube(points, axes, seed);
            for axis in 0..axes {
                let mut slices: Vec<usize> = all
                    .iter()
                    .map(|point| (point[axis] * points as f64) as usize)
                    .collect();
                slices.sort_unstable();
                assert_eq!(slices, (0..points).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn a_seed_gives_the_same_points_and_another_one_others() {
        assert_eq!(latin_hypercube(20, 4, 1), latin_hypercube(20, 4, 1));
        assert_ne!(latin_hypercube(20, 4, 1), latin_hypercube(20, 4, 2));
    }

    #[test]
    fn axes_know_nothing_of_each_other() {
        let all = latin_hypercube(2000, 2, 3);
        let product: f64 = all
            .iter()
            .map(|point| (point[0] - 0.5) * (point[1] - 0.5))
            .sum();
        // Three standard deviations of a correlation of 2000 points.
        assert!((12.0 * product / 2000.0).abs() < 3.0 / 2000.0_f64.sqrt());
    }
}
