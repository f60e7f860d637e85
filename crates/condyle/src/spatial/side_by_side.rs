//! A pose and a twist for four points at a time.

use super::{Pose, Twist, body::Femur};
use crate::{
    Vec3, Vector,
    number::vector::{dot, scale_add},
    number::{F64x4, Number},
};

/// A pose of the femur in the insert for four points at a time.
pub struct Pose4 {
    /// Columns of R.
    columns: [Vector<F64x4>; 3],
    translation: Vector<F64x4>,
}

impl Pose4 {
    /// The same pose for every point.
    pub fn new(pose: &Pose) -> Self {
        let column = |axis: usize| Vec3::from(pose.rotation.column(axis)).map(F64x4::splat);
        Self {
            columns: [column(0), column(1), column(2)],
            translation: pose.translation.map(F64x4::splat),
        }
    }

    /// Points of the insert frame seen from the femoral frame.
    #[inline(always)]
    pub fn to_femur(&self, point: &Vector<F64x4>) -> Vector<F64x4> {
        self.turn_to_femur(&(point - self.translation))
    }

    /// Vectors of the insert frame seen from the femoral frame.
    #[inline(always)]
    pub fn turn_to_femur(&self, vector: &Vector<F64x4>) -> Vector<F64x4> {
        let [x, y, z] = &self.columns;
        Vector::new(dot(x, vector), dot(y, vector), dot(z, vector))
    }

    /// Vectors of the femoral frame seen from the insert frame.
    #[inline(always)]
    pub fn turn_to_insert(&self, vector: &Vector<F64x4>) -> Vector<F64x4> {
        let [x, y, z] = &self.columns;
        scale_add(x, vector.x, &scale_add(y, vector.y, &(z * vector.z)))
    }
}

/// A twist of the femur in its own frame, for four points at a time.
pub struct Twist4 {
    angular: Vector<F64x4>,
    linear: Vector<F64x4>,
}

impl Twist4 {
    /// The same twist for every point.
    pub fn new(twist: &Twist<Femur, Femur>) -> Self {
        Self {
            angular: twist.angular.map(F64x4::splat),
            linear: twist.linear.map(F64x4::splat),
        }
    }

    /// The angular part.
    pub fn angular(&self) -> &Vector<F64x4> {
        &self.angular
    }

    /// Velocities of the material at points, v + w x p.
    #[inline(always)]
    pub fn velocity(&self, place: &Vector<F64x4>) -> Vector<F64x4> {
        let (w, p, v) = (&self.angular, place, &self.linear);
        Vector::new(
            w.y.mul_add(p.z, v.x - w.z * p.y),
            w.z.mul_add(p.x, v.y - w.x * p.z),
            w.x.mul_add(p.y, v.z - w.y * p.x),
        )
    }
}
