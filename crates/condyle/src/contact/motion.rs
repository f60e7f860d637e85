//! The femur's motion relative to the insert.

use crate::{
    Mat3, Vec3, Vector,
    number::vector::{dot, scale_add},
    number::{F64x4, Number},
};

/// A wrench as (moment, force) or a twist as (angular, linear); N mm and N, rad and mm.
pub type Vec6 = nalgebra::Vector6<f64>;
/// A derivative of one six-vector by another.
pub type Mat6 = nalgebra::Matrix6<f64>;

/// Where the femur is in the insert frame: a point p of the femoral frame is at R p + t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// R, from the femoral frame's directions to the insert's.
    pub rotation: Mat3,
    /// t, the femoral frame's origin in the insert frame, mm.
    pub translation: Vec3,
}

impl Pose {
    /// The femoral frame on the insert frame.
    pub fn identity() -> Self {
        Self {
            rotation: Mat3::identity(),
            translation: Vec3::zeros(),
        }
    }

    /// A point of the insert frame seen from the femoral frame.
    #[inline]
    pub fn to_femur(&self, point: &Vec3) -> Vec3 {
        self.rotation.tr_mul(&(point - self.translation))
    }

    /// A point of the femoral frame seen from the insert frame.
    pub fn to_insert(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.translation
    }
}

/// A pose for four points at a time.
pub(super) struct Pose4 {
    /// Columns of R.
    columns: [Vector<F64x4>; 3],
    translation: Vector<F64x4>,
}

impl Pose4 {
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

/// A twist for four points at a time.
pub(super) struct Twist4 {
    angular: Vector<F64x4>,
    linear: Vector<F64x4>,
}

impl Twist4 {
    pub fn new(twist: &Vec6) -> Self {
        let twist = twist.map(F64x4::splat);
        Self {
            angular: twist.fixed_rows::<3>(0).into(),
            linear: twist.fixed_rows::<3>(3).into(),
        }
    }

    /// The angular velocity.
    pub fn angular(&self) -> &Vector<F64x4> {
        &self.angular
    }

    /// Velocities of points.
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

/// Pose and velocity of the femur relative to the insert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeMotion {
    /// Where the femur is.
    pub pose: Pose,
    /// Angular velocity, rad/s, then the velocity of the femur's material at the insert's origin,
    /// mm/s; in the insert frame.
    pub twist: Vec6,
}

/// The small motion from one pose to another, a turn and the shift of the femur's material at the
/// insert's origin; in the insert frame.
pub(super) fn small_motion(from: &Pose, to: &Pose) -> Vec6 {
    let turned = to.rotation * from.rotation.transpose();
    let turn = Vec3::new(
        turned[(2, 1)] - turned[(1, 2)],
        turned[(0, 2)] - turned[(2, 0)],
        turned[(1, 0)] - turned[(0, 1)],
    ) / 2.0;
    let shift = to.translation - from.translation - turn.cross(&from.translation);
    Vec6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z)
}

/// The matrix \[v\] with \[v\] w = v x w.
#[inline]
pub fn cross_matrix(v: &Vec3) -> Mat3 {
    Mat3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// The 6 by 6 matrix that turns a twist in the insert frame, taken at the insert's origin, into
/// one in the femoral frame, taken at the femur's origin. Its transpose turns wrenches back.
pub(super) fn twist_to_femur(pose: &Pose) -> Mat6 {
    let turn = pose.rotation.transpose();
    let mut matrix = Mat6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
    let lever = -turn * cross_matrix(&pose.translation);
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&lever);
    matrix
}
