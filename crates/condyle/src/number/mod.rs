//! Scalars and vectors of lanes behind one interface, symmetric matrices of them (`symmetric`), and the fixed point of a map
//! (`mixing`).
//!
//! The formulas of the hot loop are written once, for any [`Number`]. With [`F64x4`] they work on
//! four nodes at a time, which the compiler turns into vector instructions on any machine; every
//! lane does the same operations in the same order as a single number would, so the results do not
//! depend on how wide the machine's vectors are.

mod mixing;
mod symmetric;

use std::{
    fmt::Debug,
    ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign},
};

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};
use wide::{f32x8, f64x4};

use crate::{Vec3, Vector};
pub(crate) use mixing::{Mixing, Turns};
pub(crate) use symmetric::Symmetric;

/// A real number, or several side by side.
pub trait Number:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Zero
    + One
    + Neg<Output = Self>
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
{
    /// Creates a number with the same value in every lane.
    fn splat(value: f64) -> Self;
    const COUNT: usize;
    /// Returns a number from its lanes.
    fn from_lanes(value: impl FnMut(usize) -> f64) -> Self;
    /// Returns the value in one lane.
    fn lane(self, lane: usize) -> f64;

    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// Returns the largest integer that is not larger than `self`.
    fn floor(self) -> Self;
    /// `self` times `factor` plus `addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `self` times `factor` less `subtrahend`, rounded once.
    fn mul_sub(self, factor: Self, subtrahend: Self) -> Self;
    fn max(self, other: Self) -> Self;
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }
    /// Returns the smallest lane.
    fn least(self) -> f64;
    /// `then` where `self` is below zero, `otherwise` elsewhere.
    fn below_zero(self, then: Self, otherwise: Self) -> Self;
}

/// Declares methods that are always inlined: the compiler must see through all layers of the hot loop.
macro_rules! inlined {
    ($(fn $name:ident($($arguments:tt)*) -> $result:ty $body:block)*) => {$(
        #[inline(always)]
        fn $name($($arguments)*) -> $result $body
    )*};
}

impl Number for f64 {
    const COUNT: usize = 1;

    inlined! {
        fn splat(value: f64) -> Self { value }
        fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self { value(0) }
        fn lane(self, _lane: usize) -> f64 { self }
        fn sqrt(self) -> Self { f64::sqrt(self) }
        fn abs(self) -> Self { f64::abs(self) }
        fn floor(self) -> Self { f64::floor(self) }
        fn mul_add(self, factor: Self, addend: Self) -> Self { f64::mul_add(self, factor, addend) }
        fn mul_sub(self, factor: Self, subtrahend: Self) -> Self { f64::mul_add(self, factor, -subtrahend) }
        fn max(self, other: Self) -> Self { if self > other { self } else { other } }
        fn least(self) -> f64 { self }
        fn below_zero(self, then: Self, otherwise: Self) -> Self { if self < 0.0 { then } else { otherwise } }
    }
}

/// Zero, written out: the compiler does not split up nalgebra's repetition of it.
#[inline(always)]
pub fn zero_vector<T: Number>() -> Vector<T> {
    Vector::new(T::zero(), T::zero(), T::zero())
}

/// a . b
#[inline(always)]
pub fn dot<T: Number>(a: &Vector<T>, b: &Vector<T>) -> T {
    a.x.mul_add(b.x, a.y.mul_add(b.y, a.z * b.z))
}

/// a x b
#[inline(always)]
pub fn cross<T: Number>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    Vector::new(
        a.y.mul_sub(b.z, a.z * b.y),
        a.z.mul_sub(b.x, a.x * b.z),
        a.x.mul_sub(b.y, a.y * b.x),
    )
}

/// v f + w
#[inline(always)]
pub fn scale_add<T: Number>(v: &Vector<T>, f: T, w: &Vector<T>) -> Vector<T> {
    Vector::new(
        v.x.mul_add(f, w.x),
        v.y.mul_add(f, w.y),
        v.z.mul_add(f, w.z),
    )
}

/// v without its part along a unit vector n: v - n (n . v)
#[inline(always)]
pub fn tangential_part<T: Number>(v: &Vector<T>, n: &Vector<T>) -> Vector<T> {
    scale_add(n, -dot(n, v), v)
}

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
            const COUNT: usize = $count;

            inlined! {
                fn splat(value: f64) -> Self { Self($wide::splat(value as $single)) }
                fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
                    let mut lanes = [0.0; $count];
                    for (lane, number) in lanes.iter_mut().enumerate() {
                        *number = value(lane) as $single;
                    }
                    Self($wide::new(lanes))
                }
                fn lane(self, lane: usize) -> f64 { self.0.as_array()[lane].into() }
                fn sqrt(self) -> Self { Self(self.0.sqrt()) }
                fn abs(self) -> Self { Self(self.0.abs()) }
                fn floor(self) -> Self { Self(self.0.floor()) }
                fn mul_add(self, factor: Self, addend: Self) -> Self { Self(self.0.mul_add(factor.0, addend.0)) }
                fn mul_sub(self, factor: Self, less: Self) -> Self { Self(self.0.mul_sub(factor.0, less.0)) }
                fn max(self, other: Self) -> Self { Self(self.0.fast_max(other.0)) }
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
                fn below_zero(self, then: Self, otherwise: Self) -> Self {
                    Self(self.0.simd_lt($wide::ZERO).select(then.0, otherwise.0))
                }
            }
        }

        impl Neg for $name {
            type Output = Self;

            inlined! { fn neg(self) -> Self { Self(-self.0) } }
        }

        impl Zero for $name {
            inlined! {
                fn zero() -> Self { Self::splat(0.0) }
                fn is_zero(&self) -> bool { *self == Self::zero() }
            }
        }

        impl One for $name {
            inlined! { fn one() -> Self { Self::splat(1.0) } }
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

            inlined! { fn $method(self, other: Self) -> Self { Self(self.0.$method(other.0)) } }
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
    fn products_are_those_of_the_vectors() {
        let (a, b) = (Vec3::new(1.5, -2.0, 0.7), Vec3::new(-0.3, 4.0, 2.5));
        assert!((dot(&a, &b) - a.dot(&b)).abs() < 1e-14);
        assert!((cross(&a, &b) - a.cross(&b)).norm() < 1e-14);
        assert!((scale_add(&a, 3.0, &b) - (a * 3.0 + b)).norm() < 1e-14);
        let n = b.normalize();
        assert!(dot(&tangential_part(&a, &n), &n).abs() < 1e-14);
    }

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
