//! One number or four at a time.
//!
//! The formulas of the hot loop are written once, for any [`Number`]. With [`Lanes`] they work on
//! four nodes at a time, which the compiler turns into vector instructions on any machine; every
//! lane does the same operations in the same order as a single number would, so the results do not
//! depend on how wide the machine's vectors are.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use wide::f64x4;

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
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// `self` times `factor` plus `addend`, rounded once.
    fn times_plus(self, factor: Self, addend: Self) -> Self;
    /// `self` times `factor` less `subtrahend`, rounded once.
    fn times_minus(self, factor: Self, subtrahend: Self) -> Self;
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
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }

    #[inline(always)]
    fn times_minus(self, factor: Self, subtrahend: Self) -> Self {
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

/// How many nodes go side by side.
pub const LANES: usize = 4;

/// Four numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Lanes(f64x4);

impl Lanes {
    /// Four numbers.
    #[inline(always)]
    pub fn new(lanes: [f64; LANES]) -> Self {
        Self(f64x4::new(lanes))
    }

    /// The four numbers.
    #[inline(always)]
    pub fn to_array(self) -> [f64; LANES] {
        self.0.to_array()
    }

    /// The sum over the lanes, always in the same order.
    #[inline]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = self.to_array();
        (a + b) + (c + d)
    }

    /// The largest lane.
    #[inline(always)]
    pub fn greatest(self) -> f64 {
        -(-self).least()
    }
}

impl Number for Lanes {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(f64x4::splat(value))
    }

    const COUNT: usize = LANES;

    #[inline(always)]
    fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        Self::new([value(0), value(1), value(2), value(3)])
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0.as_array()[lane]
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0))
    }

    #[inline(always)]
    fn times_minus(self, factor: Self, subtrahend: Self) -> Self {
        Self(self.0.mul_sub(factor.0, subtrahend.0))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.fast_max(other.0))
    }

    #[inline(always)]
    fn least(self) -> f64 {
        let [a, b, c, d] = self.to_array();
        let smaller = |x: f64, y: f64| if x < y { x } else { y };
        smaller(smaller(a, b), smaller(c, d))
    }

    #[inline(always)]
    fn below_zero(self, then: Self, otherwise: Self) -> Self {
        Self(self.0.simd_lt(f64x4::ZERO).select(then.0, otherwise.0))
    }
}

macro_rules! operators {
    ($($operation:ident $method:ident $assign_operation:ident $assign_method:ident;)*) => {$(
        impl $operation for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl $assign_operation for Lanes {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

operators! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div DivAssign div_assign;
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for Lanes {
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Lanes {
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_does_as_a_single_number_does() {
        let (a, b) = ([1.5, -2.0, 0.3, 7.0], [0.1, 3.0, -0.7, 7.0]);
        let formula = |x: f64, y: f64| ((x * y - x / y).abs() + y).sqrt().max(x);
        let lanes = Lanes::new(a);
        let other = Lanes::new(b);
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
        let chosen = lanes.below_zero(Lanes::zero(), Lanes::one());
        assert_eq!(chosen.to_array(), [1.0, 0.0, 1.0, 1.0]);
        assert_eq!(lanes.sum(), (1.5 - 2.0) + (0.3 + 7.0));
    }
}
