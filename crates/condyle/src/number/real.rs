//! A real number, or several side by side, and vectors of them.

use std::{
    fmt::Debug,
    ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign},
};

use num_traits::{One, Zero};

use crate::Vector;

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
    /// Creates a number with the same value in every lane.
    fn splat(value: f64) -> Self;
    /// The number of lanes.
    const COUNT: usize;
    /// Returns a number from its lanes.
    fn from_lanes(value: impl FnMut(usize) -> f64) -> Self;
    /// Returns the value in one lane.
    fn lane(self, lane: usize) -> f64;

    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Returns the largest integer that is not larger than `self`.
    fn floor(self) -> Self;
    /// `self` times `factor` plus `addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `self` times `factor` less `subtrahend`, rounded once.
    fn mul_sub(self, factor: Self, subtrahend: Self) -> Self;
    /// Returns the larger of two.
    fn max(self, other: Self) -> Self;
    /// Returns the smaller of two.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }
    /// Returns the smallest lane.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    #[test]
    fn products_are_those_of_the_vectors() {
        let (a, b) = (Vec3::new(1.5, -2.0, 0.7), Vec3::new(-0.3, 4.0, 2.5));
        assert!((dot(&a, &b) - a.dot(&b)).abs() < 1e-14);
        assert!((cross(&a, &b) - a.cross(&b)).norm() < 1e-14);
        assert!((scale_add(&a, 3.0, &b) - (a * 3.0 + b)).norm() < 1e-14);
        let n = b.normalize();
        assert!(dot(&tangential_part(&a, &n), &n).abs() < 1e-14);
    }
}
