//! Where one body is, as seen from the other.

use std::marker::PhantomData;

use super::body::{Body, Femur, Insert};
use crate::{Mat3, Vec3};

/// Where the body `Of` is in the frame of the body `In`: a point p of its frame is at R p + t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<In: Body = Insert, Of: Body = Femur> {
    /// R, from the directions of `Of` to those of `In`.
    pub rotation: Mat3,
    /// t, the origin of `Of` in the frame of `In`, mm.
    pub translation: Vec3,
    bodies: PhantomData<(In, Of)>,
}

impl<In: Body, Of: Body> Pose<In, Of> {
    /// A pose from R, a rotation, and t, mm.
    pub fn new(rotation: Mat3, translation: Vec3) -> Self {
        Self {
            rotation,
            translation,
            bodies: PhantomData,
        }
    }

    /// One frame on the other.
    pub fn identity() -> Self {
        Self::new(Mat3::identity(), Vec3::zeros())
    }

    /// A point of the frame of `In` as seen from `Of`, mm.
    #[inline]
    pub fn inverse_point(&self, point: &Vec3) -> Vec3 {
        self.rotation.tr_mul(&(point - self.translation))
    }

    /// A point of the frame of `Of` as seen from `In`, mm.
    pub fn point(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.translation
    }

    /// The pose after a motion of `Of` in its own frame: this one, then `inner`.
    pub fn then(&self, inner: &Pose<Of, Of>) -> Self {
        Self::new(
            self.rotation * inner.rotation,
            self.point(&inner.translation),
        )
    }
}

impl Pose<Insert, Femur> {
    /// A point of the insert frame seen from the femoral frame, mm.
    #[inline]
    pub fn to_femur(&self, point: &Vec3) -> Vec3 {
        self.inverse_point(point)
    }

    /// A point of the femoral frame seen from the insert frame, mm.
    pub fn to_insert(&self, point: &Vec3) -> Vec3 {
        self.point(point)
    }
}
