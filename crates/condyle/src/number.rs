//! One number or four at a time.
//!
//! The formulas of the hot loop are written once, for any [`Number`]. With [`Lanes`] they work on
//! four nodes at a time, which the compiler turns into vector instructions on any machine; every
//! lane does the same operations in the same order as a single number would, so the results do not
//! depend on how wide the machine's vectors are.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

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
    /// The larger of two.
    fn max(self, other: Self) -> Self;
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
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
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
#[repr(align(32))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|lane| {
            function(self.0[lane], other.0[lane])
        }))
    }

    /// The sum over the lanes, always in the same order.
    #[inline]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }

    /// The smallest lane.
    #[inline(always)]
    pub fn least(self) -> f64 {
        let [a, b, c, d] = self.0;
        let smaller = |x: f64, y: f64| if x < y { x } else { y };
        smaller(smaller(a, b), smaller(c, d))
    }
}

impl Number for Lanes {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    const COUNT: usize = LANES;

    #[inline(always)]
    fn from_lanes(value: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(value))
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, Number::max)
    }

    #[inline(always)]
    fn below_zero(self, then: Self, otherwise: Self) -> Self {
        Self(std::array::from_fn(|lane| {
            self.0[lane].below_zero(then.0[lane], otherwise.0[lane])
        }))
    }
}

macro_rules! operators {
    ($($operation:ident $method:ident $assign_operation:ident $assign_method:ident;)*) => {$(
        impl $operation for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, f64::$method)
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
        Self(self.0.map(Neg::neg))
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
        let lanes = Lanes(a);
        let other = Lanes(b);
        let together = Number::max(
            Number::sqrt(Number::abs(lanes * other - lanes / other) + other),
            lanes,
        );
        for lane in 0..LANES {
            let single = Number::max(formula(a[lane], b[lane]), a[lane]);
            assert!(together.0[lane] == single || (together.0[lane].is_nan() && single.is_nan()));
        }
        let chosen = lanes.below_zero(Lanes::zero(), Lanes::one());
        assert_eq!(chosen.0, [1.0, 0.0, 1.0, 1.0]);
        assert_eq!(lanes.sum(), (1.5 - 2.0) + (0.3 + 7.0));
    }
}
