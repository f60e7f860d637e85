//! How a body moves past the other.

use std::{
    iter::Sum,
    marker::PhantomData,
    ops::{Add, AddAssign, Mul},
};

use super::{
    Pose, Vec6,
    body::{Body, Femur, Insert},
};
use crate::Vec3;

/// The motion of the body `Of` past the other one, in the frame of `In`.
///
/// It is a rate (rad/s, mm/s), a short motion (rad, mm), or the screw of a joint: the motion for each
/// unit of its position. The velocity of the material at p is v + w x p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<Of: Body = Femur, In: Body = Insert> {
    /// Angular part w, rad/s or rad.
    pub angular: Vec3,
    /// Linear part v, that of the material of `Of` at the origin of `In`, mm/s or mm.
    pub linear: Vec3,
    bodies: PhantomData<(Of, In)>,
}

impl<Of: Body, In: Body> Twist<Of, In> {
    /// A twist from its angular and its linear part.
    pub fn new(angular: Vec3, linear: Vec3) -> Self {
        Self {
            angular,
            linear,
            bodies: PhantomData,
        }
    }

    /// No motion.
    pub fn zero() -> Self {
        Self::new(Vec3::zeros(), Vec3::zeros())
    }

    /// The screw of a turn about an axis with a unit `direction` through `centre`, mm.
    pub fn about(direction: Vec3, centre: Vec3) -> Self {
        Self::new(direction, centre.cross(&direction))
    }

    /// The screw of a shift along a unit `direction`.
    pub fn along(direction: Vec3) -> Self {
        Self::new(Vec3::zeros(), direction)
    }

    /// The Lie bracket: how this screw turns `other`, which it carries, for each unit of position.
    pub fn bracket(&self, other: &Self) -> Self {
        Self::new(
            self.angular.cross(&other.angular),
            self.angular.cross(&other.linear) - other.angular.cross(&self.linear),
        )
    }

    /// The finite motion along a screw by `position`, rad or mm: its exponential.
    pub fn exponential(&self, position: f64) -> Pose<Of, Of> {
        if self.angular == Vec3::zeros() {
            return Pose::new(crate::Mat3::identity(), self.linear * position);
        }
        let rotation = nalgebra::Rotation3::new(self.angular * position).into_inner();
        let centre = self.angular.cross(&self.linear);
        Pose::new(rotation, centre - rotation * centre)
    }

    /// The screw as it stands once `pose` has carried it along.
    pub fn carried(&self, pose: &Pose<In, Of>) -> Self {
        let turned = pose.rotation * self.angular;
        Self::new(
            turned,
            pose.rotation * self.linear + pose.translation.cross(&turned),
        )
    }

    /// The six numbers side by side.
    pub fn numbers(&self) -> Vec6 {
        let (w, v) = (&self.angular, &self.linear);
        Vec6::new(w.x, w.y, w.z, v.x, v.y, v.z)
    }

    /// From six numbers side by side.
    pub fn of_numbers(numbers: &Vec6) -> Self {
        Self::new(
            numbers.fixed_rows::<3>(0).into(),
            numbers.fixed_rows::<3>(3).into(),
        )
    }
}

impl Twist<Femur, Insert> {
    /// The short motion from one pose to another.
    pub fn between(from: &Pose, to: &Pose) -> Self {
        let turned = to.rotation * from.rotation.transpose();
        let turn = Vec3::new(
            turned[(2, 1)] - turned[(1, 2)],
            turned[(0, 2)] - turned[(2, 0)],
            turned[(1, 0)] - turned[(0, 1)],
        ) / 2.0;
        let shift = to.translation - from.translation - turn.cross(&from.translation);
        Self::new(turn, shift)
    }
}

impl<Of: Body, In: Body> Add for Twist<Of, In> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.angular + other.angular, self.linear + other.linear)
    }
}

impl<Of: Body, In: Body> AddAssign for Twist<Of, In> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<Of: Body, In: Body> Mul<f64> for Twist<Of, In> {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self::new(self.angular * factor, self.linear * factor)
    }
}

impl<Of: Body, In: Body> Sum for Twist<Of, In> {
    fn sum<I: Iterator<Item = Self>>(twists: I) -> Self {
        twists.fold(Self::zero(), Add::add)
    }
}
