//! Random numbers that are the same for a seed on every machine and in every version.

/// The SplitMix64 generator (Steele, Lea and Flood 2014).
pub(crate) struct Random(u64);

/// The increment of SplitMix64: 2^64 over the golden ratio, odd, so that the state visits every number once.
const INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;

impl Random {
    /// Creates stream `number` of a seed; streams are independent, so that each can be drawn without the others.
    pub fn stream(seed: u64, number: u64) -> Self {
        // Both parts are mixed, since seeds and numbers are small and their sums would coincide.
        let numbered = mixed(number.wrapping_add(INCREMENT).wrapping_mul(INCREMENT));
        Self(mixed(seed.wrapping_add(INCREMENT)) ^ numbered)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(INCREMENT);
        mixed(self.0)
    }

    /// Returns a uniform number between 0 and 1, both excluded: the inverse of a distribution is then finite.
    pub fn share(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Returns a uniform index below `count`.
    pub fn index(&mut self, count: usize) -> usize {
        (self.share() * count as f64) as usize
    }

    /// Shuffles `values` (Fisher and Yates).
    pub fn shuffle(&mut self, values: &mut [usize]) {
        for last in (1..values.len()).rev() {
            let other = self.index(last + 1);
            values.swap(last, other);
        }
    }
}

/// Returns a hash of 64 bits in which every bit of the result depends on every bit of `value`.
pub(crate) fn mixed(value: u64) -> u64 {
    let mixed = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}
