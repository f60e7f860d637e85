//! Numbers side by side.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use wide::{f32x8, f64x4};

use super::real::Number;
use crate::{Vec3, Vector};

/// The number of lanes in double precision: nodes that are computed side by side.
pub const LANES: usize = 4;

/// The number of lanes in single precision.
pub const LANES_F32: usize = 8;

/// Four numbers side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct F64x4(f64x4);

/// Eight numbers of single precision side by side, where six digits are enough.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct F32x8(f32x8);

impl F64x4 {
    /// Four numbers.
    #[inline(always)]
    pub fn new(lanes: [f64; LANES]) -> Self {
        Self(f64x4::new(lanes))
    }

    /// Returns the four numbers.
    #[inline(always)]
    pub fn to_array(self) -> [f64; LANES] {
        self.0.to_array()
    }

    /// Returns the columns of a matrix of four rows.
    #[inline(always)]
    pub fn transposed(rows: [Self; LANES]) -> [Self; LANES] {
        let [a, b, c, d] = rows;
        let [a, b, c, d] = f64x4::transpose([a.0, b.0, c.0, d.0]);
        [Self(a), Self(b), Self(c), Self(d)]
    }

    /// Returns the sum over the lanes, always in the same order.
    #[inline]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = self.to_array();
        (a + b) + (c + d)
    }

    /// Returns the largest lane.
    #[inline(always)]
    pub fn greatest(self) -> f64 {
        let [a, b, c, d] = self.to_array();
        let larger = |x: f64, y: f64| if x > y { x } else { y };
        larger(larger(a, b), larger(c, d))
    }
}

impl F32x8 {
    /// Eight numbers.
    #[inline(always)]
    pub fn new(lanes: [f32; LANES_F32]) -> Self {
        Self(f32x8::new(lanes))
    }

    /// Returns the eight numbers.
    #[inline(always)]
    pub fn to_array(self) -> [f32; LANES_F32] {
        self.0.to_array()
    }

    /// Returns a bit mask of the lanes that are not above zero.
    #[inline(always)]
    pub fn not_above_zero(self) -> u32 {
        (1 << LANES_F32) - 1 - self.0.simd_gt(f32x8::ZERO).to_bitmask()
    }

    /// Combines two groups of four numbers.
    #[inline(always)]
    pub fn pair(one: F64x4, other: F64x4) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (one.to_array(), other.to_array());
        Self(f32x8::new([a, b, c, d, e, f, g, h].map(|x| x as f32)))
    }

    /// Returns the sum over the lanes, always in the same order.
    #[inline]
    pub fn sum(self) -> f64 {
        self.0.to_array().map(f64::from).iter().sum()
    }
}

/// Combines four vectors, one per lane.
#[inline(always)]
pub(crate) fn vector_from_lanes<'a>(of: impl Fn(usize) -> &'a Vec3) -> Vector<F64x4> {
    let lanes: [&Vec3; LANES] = [of(0), of(1), of(2), of(3)];
    let along = |axis: usize| F64x4::from_lanes(|lane| lanes[lane][axis]);
    Vector::new(along(0), along(1), along(2))
}

macro_rules! side_by_side {
    ($name:ident, $wide:ident, $single:ident, $count:ident) => {
        impl Number for $name {
            #[inline(always)]
            fn splat(value: f64) -> Self {
                Self($wide::splat(value as $single))
            }

            const COUNT: usize = $count;

            #[inline(always)]
            fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
                let mut lanes = [0.0; $count];
                for (lane, number) in lanes.iter_mut().enumerate() {
                    *number = value(lane) as $single;
                }
                Self($wide::new(lanes))
            }

            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                self.0.as_array()[lane].into()
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
            fn floor(self) -> Self {
                Self(self.0.floor())
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                Self(self.0.mul_add(factor.0, addend.0))
            }

            #[inline(always)]
            fn mul_sub(self, factor: Self, subtrahend: Self) -> Self {
                Self(self.0.mul_sub(factor.0, subtrahend.0))
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(self.0.fast_max(other.0))
            }

            #[inline(always)]
            fn least(self) -> f64 {
                let smaller = |x: $single, y: $single| if x < y { x } else { y };
                let mut lanes = self.0.to_array();
                let mut left = $count;
                while left > 1 {
                    left /= 2;
                    for lane in 0..left {
                        lanes[lane] = smaller(lanes[lane], lanes[lane + left]);
                    }
                }
                lanes[0].into()
            }

            #[inline(always)]
            fn below_zero(self, then: Self, otherwise: Self) -> Self {
                Self(self.0.simd_lt($wide::ZERO).select(then.0, otherwise.0))
            }
        }

        impl Neg for $name {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl Zero for $name {
            #[inline(always)]
            fn zero() -> Self {
                Self::splat(0.0)
            }

            fn is_zero(&self) -> bool {
                *self == Self::zero()
            }
        }

        impl One for $name {
            #[inline(always)]
            fn one() -> Self {
                Self::splat(1.0)
            }
        }

        operators! { $name
            Add add AddAssign add_assign;
            Sub sub SubAssign sub_assign;
            Mul mul MulAssign mul_assign;
            Div div DivAssign div_assign;
        }
    };
}

macro_rules! operators {
    ($name:ident $($operation:ident $method:ident $assign_operation:ident $assign_method:ident;)*) => {$(
        impl $operation for $name {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl $assign_operation for $name {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

side_by_side! {F64x4, f64x4, f64, LANES}
side_by_side! {F32x8, f32x8, f32, LANES_F32}

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
