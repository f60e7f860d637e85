//! Moment and force on a body.

use std::{
    marker::PhantomData,
    ops::{Add, Mul},
};

use super::{
    Mat6, Twist, Vec6,
    body::{Body, Femur, Insert},
};
use crate::Vec3;

/// Moment about the origin of `In` and force on the body `On` by the other one, in the frame of `In`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<On: Body = Insert, In: Body = Insert> {
    /// Moment, N mm.
    pub moment: Vec3,
    /// Force, N.
    pub force: Vec3,
    bodies: PhantomData<(On, In)>,
}

impl<On: Body, In: Body> Wrench<On, In> {
    /// A wrench from its moment, N mm, and its force, N.
    pub fn new(moment: Vec3, force: Vec3) -> Self {
        Self {
            moment,
            force,
            bodies: PhantomData,
        }
    }

    /// No load.
    pub fn zero() -> Self {
        Self::new(Vec3::zeros(), Vec3::zeros())
    }

    /// What acts on the other body: action equals reaction.
    pub fn reaction(&self) -> Wrench<On::Other, In> {
        Wrench::new(-self.moment, -self.force)
    }

    /// What the wrench does on a motion of the body that it acts on, N mm/s; for a screw, the load on
    /// its joint, N or N mm.
    pub fn power(&self, twist: &Twist<On, In>) -> f64 {
        twist.numbers().dot(&self.numbers())
    }

    /// The wrench whose power on any screw is this one's on the bracket of `carrying` with that screw: how the load
    /// on a joint changes as another turns it.
    ///
    /// W . \[a, b\] = (m x a_w + f x a_v) . b_w + (f x a_w) . b_v.
    pub fn on_bracket_with(&self, carrying: &Twist<On, In>) -> Self {
        let (m, f) = (&self.moment, &self.force);
        let (turn, shift) = (&carrying.angular, &carrying.linear);
        Self::new(m.cross(turn) + f.cross(shift), f.cross(turn))
    }

    /// The six numbers side by side.
    pub fn numbers(&self) -> Vec6 {
        let (m, f) = (&self.moment, &self.force);
        Vec6::new(m.x, m.y, m.z, f.x, f.y, f.z)
    }

    /// From six numbers side by side.
    pub fn of_numbers(numbers: &Vec6) -> Self {
        Self::new(
            numbers.fixed_rows::<3>(0).into(),
            numbers.fixed_rows::<3>(3).into(),
        )
    }
}

impl<On: Body, In: Body> Add for Wrench<On, In> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.moment + other.moment, self.force + other.force)
    }
}

/// Derivative of a wrench on the insert by a twist of the femur, both in the frame of `In`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchByTwist<In: Body = Insert> {
    /// Rows: moment, then force. Columns: angular, then linear.
    pub matrix: Mat6,
    frame: PhantomData<In>,
}

impl<In: Body> WrenchByTwist<In> {
    /// A derivative from its matrix.
    pub fn new(matrix: Mat6) -> Self {
        Self {
            matrix,
            frame: PhantomData,
        }
    }

    /// A wrench that does not change.
    pub fn zero() -> Self {
        Self::new(Mat6::zeros())
    }
}

impl<In: Body> Mul<&Twist<Femur, In>> for &WrenchByTwist<In> {
    type Output = Wrench<Insert, In>;

    fn mul(self, twist: &Twist<Femur, In>) -> Wrench<Insert, In> {
        Wrench::of_numbers(&(self.matrix * twist.numbers()))
    }
}
