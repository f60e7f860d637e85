//! Vectors of numbers, and their products, whose sums are rounded once: half the instructions of products and sums.

use super::{
    lanes::{F64x4, LANES},
    real::Number,
};
use crate::{Vec3, Vector};

/// Zero, written out: the compiler does not take nalgebra's repetition of it apart.
#[inline(always)]
pub fn zero_vector<T: Number>() -> Vector<T> {
    Vector::new(T::zero(), T::zero(), T::zero())
}

/// Four vectors side by side, each of a lane.
#[inline(always)]
pub fn vector_from_lanes<'a>(of: impl Fn(usize) -> &'a Vec3) -> Vector<F64x4> {
    let lanes: [&Vec3; LANES] = [of(0), of(1), of(2), of(3)];
    let along = |axis: usize| F64x4::from_lanes(|lane| lanes[lane][axis]);
    Vector::new(along(0), along(1), along(2))
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
