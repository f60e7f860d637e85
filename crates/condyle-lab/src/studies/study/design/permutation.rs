//! An order of chance whose places are found one by one.

use super::super::super::chance::{Numbers, mixed};

/// Rounds of the network; four make a good cipher of one whose rounds are good (Luby and Rackoff 1988).
const ROUNDS: usize = 6;

/// All numbers below a count in an order of chance; each is found without the others.
///
/// A Feistel network permutes the numbers of an even count of bits whatever its rounds are; what it puts beyond the count
/// goes through it again until it lies below.
pub(super) struct Permutation {
    count: u64,
    half_bits: u32,
    keys: [u64; ROUNDS],
}

impl Permutation {
    pub fn new(count: u64, numbers: &mut Numbers) -> Self {
        let bits = u64::BITS - (count.max(2) - 1).leading_zeros();
        Self {
            count,
            half_bits: bits.div_ceil(2),
            keys: std::array::from_fn(|_| numbers.next()),
        }
    }

    /// The number at `place`, which lies below the count.
    pub fn at(&self, place: u64) -> u64 {
        let mut found = self.through(place);
        while found >= self.count {
            found = self.through(found);
        }
        found
    }

    fn through(&self, value: u64) -> u64 {
        let mask = (1 << self.half_bits) - 1;
        let halves = (value >> self.half_bits, value & mask);
        let (left, right) = self.keys.iter().fold(halves, |(left, right), key| {
            (right, left ^ (mixed(right ^ key) & mask))
        });
        (left << self.half_bits) | right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_every_number_comes_once() {
        for count in [1, 2, 3, 10, 100, 4097] {
            let order = Permutation::new(count, &mut Numbers::of(count));
            let mut all: Vec<u64> = (0..count).map(|place| order.at(place)).collect();
            all.sort_unstable();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }
}
