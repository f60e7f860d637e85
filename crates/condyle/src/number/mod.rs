//! One number, or several at a time.
//!
//! The formulas of the hot loop are written once, for any [`Number`]. With [`F64x4`] they work on
//! four nodes at a time, which the compiler turns into vector instructions on any machine; every
//! lane does the same operations in the same order as a single number would, so the results do not
//! depend on how wide the machine's vectors are.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

mod lanes;

pub use lanes::{F32x8, F64x4, LANES, LANES_F32};

/// A real number, or several side by side.
pub trait Number:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Zero
    + One
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// How many lanes there are.
    const COUNT: usize;
    /// A number from its lanes.
    fn from_lanes(value: impl FnMut(usize) -> f64) -> Self;
    /// The value in one lane.
    fn lane(self, lane: usize) -> f64;

    /// The first three columns of a matrix that has a row of four numbers for every lane.
    #[inline(always)]
    fn columns(rows: &[F64x4; LANES]) -> [Self; 3] {
        let [a, b, c, _] = F64x4::transposed(*rows);
        let lanes = |column: F64x4| Self::from_lanes(|lane| column.lane(lane));
        [lanes(a), lanes(b), lanes(c)]
    }

    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The largest whole number that is not larger.
    fn floor(self) -> Self;
    /// `self` times `factor` plus `addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `self` times `factor` less `subtrahend`, rounded once.
    fn mul_sub(self, factor: Self, subtrahend: Self) -> Self;
    /// The larger of two.
    fn max(self, other: Self) -> Self;
    /// The smallest lane.
    fn least(self) -> f64;
    /// `then` where `self` is below zero, `otherwise` elsewhere.
    fn below_zero(self, then: Self, otherwise: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    const COUNT: usize = 1;

    #[inline(always)]
    fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        value(0)
    }

    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }

    #[inline(always)]
    fn mul_sub(self, factor: Self, subtrahend: Self) -> Self {
        self.mul_add(factor, -subtrahend)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn least(self) -> f64 {
        self
    }

    #[inline(always)]
    fn below_zero(self, then: Self, otherwise: Self) -> Self {
        if self < 0.0 { then } else { otherwise }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_does_as_a_single_number_does() {
        let (a, b) = ([1.5, -2.0, 0.3, 7.0], [0.1, 3.0, -0.7, 7.0]);
        let formula = |x: f64, y: f64| ((x * y - x / y).abs() + y).sqrt().max(x);
        let lanes = F64x4::new(a);
        let other = F64x4::new(b);
        let together = Number::max(
            Number::sqrt(Number::abs(lanes * other - lanes / other) + other),
            lanes,
        );
        for lane in 0..LANES {
            let single = Number::max(formula(a[lane], b[lane]), a[lane]);
            assert!(
                together.lane(lane) == single || (together.lane(lane).is_nan() && single.is_nan())
            );
        }
        let chosen = lanes.below_zero(F64x4::zero(), F64x4::one());
        assert_eq!(chosen.to_array(), [1.0, 0.0, 1.0, 1.0]);
        assert_eq!(lanes.sum(), (1.5 - 2.0) + (0.3 + 7.0));
    }

    #[test]
    fn singles_are_two_lanes_rounded() {
        let (a, b) = (
            F64x4::new([1.5, -2.0, 0.1, 7.0]),
            F64x4::new([3.0, 4.0, 5.0, 6.0]),
        );
        let singles = F32x8::pair(a, b);
        assert_eq!(singles.lane(1), -2.0);
        assert_eq!(singles.lane(2), f64::from(0.1_f32));
        assert_eq!(singles.lane(4), 3.0);
        assert_eq!(singles.least(), -2.0);
        assert!((singles.sum() - 24.6).abs() < 1e-6);
        let product = singles.mul_add(F32x8::splat(2.0), -singles);
        assert!((0..8).all(|lane| product.lane(lane) == singles.lane(lane)));
    }
}
