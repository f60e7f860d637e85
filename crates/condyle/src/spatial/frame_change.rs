//! From the insert frame to the femoral frame.

use super::{
    Mat6, Pose, Twist, Wrench, WrenchByTwist,
    body::{Femur, Insert},
};
use crate::{Mat3, Vec3};

/// Takes twists from the insert frame to the femoral frame, and wrenches back.
///
/// It is the 6 by 6 matrix A that turns a twist taken at the insert's origin into one taken at the
/// femur's. Power is the same in both frames, so A' takes wrenches back, and A' D A a derivative D of
/// one by the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameChange {
    matrix: Mat6,
}

impl FrameChange {
    /// The change at a pose of the femur.
    pub fn to_femur(pose: &Pose) -> Self {
        let turn = pose.rotation.transpose();
        let mut matrix = Mat6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
        let lever = -turn * cross_matrix(&pose.translation);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&lever);
        Self { matrix }
    }

    /// A twist of the femur in its own frame.
    pub fn twist(&self, twist: &Twist<Femur, Insert>) -> Twist<Femur, Femur> {
        Twist::of_numbers(&(self.matrix * twist.numbers()))
    }

    /// A wrench on the insert back in the insert frame.
    pub fn wrench_back(&self, wrench: &Wrench<Insert, Femur>) -> Wrench<Insert, Insert> {
        Wrench::of_numbers(&self.matrix.tr_mul(&wrench.numbers()))
    }

    /// A derivative of the one by the other back in the insert frame.
    pub fn derivative_back(&self, by: &WrenchByTwist<Femur>) -> WrenchByTwist<Insert> {
        WrenchByTwist::new(self.matrix.tr_mul(&by.matrix) * self.matrix)
    }
}

/// The matrix \[v\] with \[v\] w = v x w.
#[inline]
fn cross_matrix(v: &Vec3) -> Mat3 {
    Mat3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_the_same_in_both_frames() {
        let rotation = nalgebra::Rotation3::new(Vec3::new(0.3, -0.8, 0.2)).into_inner();
        let pose = Pose::new(rotation, Vec3::new(4.0, -20.0, 3.0));
        let change = FrameChange::to_femur(&pose);
        let twist = Twist::new(Vec3::new(1.0, 0.3, -2.0), Vec3::new(10.0, 3.0, 40.0));
        let wrench = Wrench::new(Vec3::new(5.0, 7.0, -1.0), Vec3::new(0.4, -3.0, 2.0));
        let power = change.wrench_back(&wrench).reaction().power(&twist);
        assert!((wrench.reaction().power(&change.twist(&twist)) - power).abs() < 1e-12);
    }

    #[test]
    fn verify_a_twist_in_the_femoral_frame_moves_the_same_material() {
        let rotation = nalgebra::Rotation3::new(Vec3::new(-0.2, 0.5, 0.9)).into_inner();
        let pose = Pose::new(rotation, Vec3::new(4.0, -20.0, 3.0));
        let twist: Twist = Twist::new(Vec3::new(1.0, 0.3, -2.0), Vec3::new(10.0, 3.0, 40.0));
        let own = FrameChange::to_femur(&pose).twist(&twist);
        let place = Vec3::new(7.0, -25.0, 12.0);
        let velocity = twist.linear + twist.angular.cross(&place);
        let seen = own.linear + own.angular.cross(&pose.to_femur(&place));
        assert!((pose.rotation * seen - velocity).norm() < 1e-12);
    }
}
