//! Poses, twists and wrenches, typed by body and frame.
//!
//! There are two bodies: the [insert](body::Insert) and the [counterface](body::Counterface). Each carries a frame of the same
//! name. A quantity's type states its body and its frame: [`Twist<Counterface, Insert>`](Twist) is the counterface's motion past
//! the insert in the insert frame, [`Wrench<Insert, Counterface>`](Wrench) acts on the insert and is expressed in the counterface
//! frame. Only a wrench on a body does work on a twist of the same body, so a forgotten sign or frame does not compile:
//!
//! ```compile_fail
//! use condyle::spatial::{Twist, Wrench, body::{Counterface, Insert}};
//! let (on_insert, of_counterface) = (Wrench::<Insert, Insert>::zero(), Twist::<Counterface, Insert>::zero());
//! on_insert.power(&of_counterface);
//! ```
//!
//! ```
//! use condyle::{Vec3, spatial::{Twist, Wrench, body::{Counterface, Insert}}};
//! let on_insert = Wrench::<Insert, Insert>::new(Vec3::zeros(), Vec3::new(0.0, -100.0, 0.0));
//! let sinking = Twist::<Counterface, Insert>::new(Vec3::zeros(), Vec3::new(0.0, -2.0, 0.0));
//! // A force of 100 N down on the insert pushes the counterface up and takes 200 N mm/s from it.
//! assert_eq!(on_insert.reaction().power(&sinking), -200.0);
//! ```

pub mod body {
    //! The bodies of a joint, as markers in types.

    use std::fmt::Debug;

    /// A body, and the frame that is fixed to it.
    pub trait Body: Copy + Debug + PartialEq + Send + Sync + 'static {
        /// The body that it articulates with.
        type Other: Body<Other = Self>;
    }

    /// The bearing, of polyethylene: an insert, a cup, a pin.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Insert {}

    /// The counterface, which is rigid: condyles, a head, a disc.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Counterface {}

    impl Body for Insert {
        type Other = Counterface;
    }

    impl Body for Counterface {
        type Other = Insert;
    }
}

use std::{
    iter::Sum,
    marker::PhantomData,
    ops::{Add, Mul},
};

use crate::{
    Mat3, Vec3, Vector,
    number::{F64x4, Number, dot, scale_add},
};
use body::{Body, Counterface, Insert};

/// Six numbers: three angular ones or a moment, then three linear ones or a force.
pub type Vec6 = nalgebra::Vector6<f64>;
/// The derivative of six numbers by six others.
pub type Mat6 = nalgebra::Matrix6<f64>;

/// The position of the body `Of` in the frame of the body `In`: a point p of its frame is at R p + t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<In: Body = Insert, Of: Body = Counterface> {
    /// R, from the directions of `Of` to those of `In`.
    pub rotation: Mat3,
    /// t, the origin of `Of` in the frame of `In`, mm.
    pub translation: Vec3,
    bodies: PhantomData<(In, Of)>,
}

impl<In: Body, Of: Body> Pose<In, Of> {
    /// Creates a pose from R, a rotation, and t, mm.
    pub fn new(rotation: Mat3, translation: Vec3) -> Self {
        Self {
            rotation,
            translation,
            bodies: PhantomData,
        }
    }

    /// Creates the pose of coincident frames.
    pub fn identity() -> Self {
        Self::new(Mat3::identity(), Vec3::zeros())
    }

    /// Converts a point from the frame of `Of` to the frame of `In`, mm.
    pub fn point(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.translation
    }

    /// Returns the pose after a motion of `Of` in its own frame: this one, then `inner`.
    pub fn then(&self, inner: &Pose<Of, Of>) -> Self {
        Self::new(
            self.rotation * inner.rotation,
            self.point(&inner.translation),
        )
    }
}

impl Pose<Insert, Counterface> {
    /// Converts a point of the insert frame to the counterface frame, mm.
    #[inline]
    pub fn to_counterface(&self, point: &Vec3) -> Vec3 {
        self.rotation.tr_mul(&(point - self.translation))
    }

    /// Converts a point of the counterface frame to the insert frame, mm.
    pub fn to_insert(&self, point: &Vec3) -> Vec3 {
        self.point(point)
    }
}

/// Pose and velocity of the counterface relative to the insert, in the insert frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeMotion {
    /// The pose of the counterface.
    pub pose: Pose,
    /// The velocity of the counterface, rad/s and mm/s.
    pub twist: Twist,
}

impl RelativeMotion {
    /// Creates a counterface at rest at a pose.
    pub fn at_rest(pose: Pose) -> Self {
        let twist = Twist::zero();
        Self { pose, twist }
    }
}

/// The motion of the body `Of` past the other one, in the frame of `In`.
///
/// It is a rate (rad/s, mm/s), a small motion (rad, mm), or the screw of a joint: the motion per
/// unit of its position. The velocity of the material at p is v + w x p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<Of: Body = Counterface, In: Body = Insert> {
    /// Angular part w, rad/s or rad.
    pub angular: Vec3,
    /// Linear part v: the motion of the material of `Of` at the origin of `In`, mm/s or mm.
    pub linear: Vec3,
    bodies: PhantomData<(Of, In)>,
}

impl<Of: Body, In: Body> Twist<Of, In> {
    /// Creates the screw of a rotation about an axis with a unit `direction` through `centre`, mm.
    pub fn about(direction: Vec3, centre: Vec3) -> Self {
        Self::new(direction, centre.cross(&direction))
    }

    /// Creates the screw of a translation along a unit `direction`.
    pub fn along(direction: Vec3) -> Self {
        Self::new(Vec3::zeros(), direction)
    }

    /// Returns the Lie bracket: the derivative of the screw `other` with respect to the position of
    /// this joint, which moves it.
    pub fn bracket(&self, other: &Self) -> Self {
        Self::new(
            self.angular.cross(&other.angular),
            self.angular.cross(&other.linear) - other.angular.cross(&self.linear),
        )
    }

    /// Returns the finite motion along a screw by `position`, rad or mm: its exponential.
    pub(crate) fn exponential(&self, position: f64) -> Pose<Of, Of> {
        // A screw without rotation has no centre.
        if self.angular == Vec3::zeros() {
            return Pose::new(Mat3::identity(), self.linear * position);
        }
        // The axis passes through w x v, since a screw of a joint has a unit direction and no pitch.
        let rotation = nalgebra::Rotation3::new(self.angular * position).into_inner();
        let centre = self.angular.cross(&self.linear);
        Pose::new(rotation, centre - rotation * centre)
    }

    /// Returns the screw carried along by `pose`.
    pub fn carried(&self, pose: &Pose<In, Of>) -> Self {
        let turned = pose.rotation * self.angular;
        Self::new(
            turned,
            pose.rotation * self.linear + pose.translation.cross(&turned),
        )
    }
}

impl Twist<Counterface, Insert> {
    /// Returns the small motion from one pose to another.
    pub fn between(from: &Pose, to: &Pose) -> Self {
        let turned = to.rotation * from.rotation.transpose();
        // The antisymmetric part of the rotation: exact to second order in the angle.
        let turn = Vec3::new(
            turned[(2, 1)] - turned[(1, 2)],
            turned[(0, 2)] - turned[(2, 0)],
            turned[(1, 0)] - turned[(0, 1)],
        ) / 2.0;
        let shift = to.translation - from.translation - turn.cross(&from.translation);
        Self::new(turn, shift)
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
    /// Returns the wrench on the other body: action equals reaction.
    pub fn reaction(&self) -> Wrench<On::Other, In> {
        Wrench::new(-self.moment, -self.force)
    }

    /// Returns the power of the wrench on a motion of the body that it acts on, N mm/s; for a screw, the load on
    /// its joint, N or N mm.
    pub fn power(&self, twist: &Twist<On, In>) -> f64 {
        twist.numbers().dot(&self.numbers())
    }

    /// Returns the wrench whose power on any screw is this one's power on the bracket of `carrying` with that screw:
    /// the derivative of the load on a joint by the position of the joint that carries it.
    ///
    /// W . \[a, b\] = (m x a_w + f x a_v) . b_w + (f x a_w) . b_v.
    pub(crate) fn on_bracket_with(&self, carrying: &Twist<On, In>) -> Self {
        let (m, f) = (&self.moment, &self.force);
        let (turn, shift) = (&carrying.angular, &carrying.linear);
        Self::new(m.cross(turn) + f.cross(shift), f.cross(turn))
    }
}

/// Implements the common part of twists and wrenches.
macro_rules! six_numbers {
    ($name:ident, $angular:ident, $linear:ident) => {
        impl<Of: Body, In: Body> $name<Of, In> {
            #[doc = concat!("Creates it from `", stringify!($angular), "` and `", stringify!($linear), "`.")]
            pub fn new($angular: Vec3, $linear: Vec3) -> Self {
                Self {
                    $angular,
                    $linear,
                    bodies: PhantomData,
                }
            }

            /// Returns six zeros.
            pub fn zero() -> Self {
                Self::new(Vec3::zeros(), Vec3::zeros())
            }

            /// Returns the six numbers.
            pub fn numbers(&self) -> Vec6 {
                let (a, l) = (&self.$angular, &self.$linear);
                Vec6::new(a.x, a.y, a.z, l.x, l.y, l.z)
            }

            /// Creates it from six numbers.
            pub fn from_numbers(numbers: &Vec6) -> Self {
                Self::new(
                    numbers.fixed_rows::<3>(0).into(),
                    numbers.fixed_rows::<3>(3).into(),
                )
            }
        }

        impl<Of: Body, In: Body> Add for $name<Of, In> {
            type Output = Self;

            fn add(self, other: Self) -> Self {
                Self::new(self.$angular + other.$angular, self.$linear + other.$linear)
            }
        }
    };
}

six_numbers!(Twist, angular, linear);
six_numbers!(Wrench, moment, force);

/// Derivative of a wrench on the insert by a twist of the counterface, both in the frame of `In`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchByTwist<In: Body = Insert> {
    /// Rows: moment, then force. Columns: angular, then linear.
    pub matrix: Mat6,
    frame: PhantomData<In>,
}

impl<In: Body> WrenchByTwist<In> {
    /// Creates a derivative from its matrix.
    pub fn new(matrix: Mat6) -> Self {
        Self {
            matrix,
            frame: PhantomData,
        }
    }

    /// Creates the derivative of a constant wrench.
    pub fn zero() -> Self {
        Self::new(Mat6::zeros())
    }
}

impl<In: Body> Mul<&Twist<Counterface, In>> for &WrenchByTwist<In> {
    type Output = Wrench<Insert, In>;

    fn mul(self, twist: &Twist<Counterface, In>) -> Wrench<Insert, In> {
        Wrench::from_numbers(&(self.matrix * twist.numbers()))
    }
}

/// Converts twists from the insert frame to the counterface frame, and wrenches back.
///
/// It is the 6 by 6 matrix A from a twist at the insert's origin to one at the
/// counterface's. Power is the same in both frames, so A' converts wrenches back, and A' D A a derivative D of
/// one by the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrameChange {
    matrix: Mat6,
}

impl FrameChange {
    /// Creates the change of frame at a pose of the counterface.
    pub fn to_counterface(pose: &Pose) -> Self {
        let turn = pose.rotation.transpose();
        let mut matrix = Mat6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
        // Moving the origin by t adds w x t to the linear part: -[t]x w, seen from the counterface.
        let lever = -turn * pose.translation.cross_matrix();
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&lever);
        Self { matrix }
    }

    /// Converts a twist of the counterface to its own frame.
    pub fn twist(&self, twist: &Twist<Counterface, Insert>) -> Twist<Counterface, Counterface> {
        Twist::from_numbers(&(self.matrix * twist.numbers()))
    }

    /// Converts a wrench on the insert back to the insert frame.
    pub fn wrench_back(&self, wrench: &Wrench<Insert, Counterface>) -> Wrench<Insert, Insert> {
        Wrench::from_numbers(&self.matrix.tr_mul(&wrench.numbers()))
    }

    /// Converts a derivative of the one by the other back to the insert frame.
    pub fn derivative_back(&self, by: &WrenchByTwist<Counterface>) -> WrenchByTwist<Insert> {
        WrenchByTwist::new(self.matrix.tr_mul(&by.matrix) * self.matrix)
    }
}

/// A pose of the counterface in the insert for four points at a time.
pub(crate) struct Pose4 {
    /// Columns of R.
    columns: [Vector<F64x4>; 3],
    translation: Vector<F64x4>,
}

impl Pose4 {
    /// Creates a pose that is the same for every point.
    pub fn new(pose: &Pose) -> Self {
        let column = |axis: usize| Vec3::from(pose.rotation.column(axis)).map(F64x4::splat);
        Self {
            columns: [column(0), column(1), column(2)],
            translation: pose.translation.map(F64x4::splat),
        }
    }

    /// Converts points of the insert frame to the counterface frame.
    #[inline(always)]
    pub fn to_counterface(&self, point: &Vector<F64x4>) -> Vector<F64x4> {
        self.turn_to_counterface(&(point - self.translation))
    }

    /// Converts vectors of the insert frame to the counterface frame.
    #[inline(always)]
    pub fn turn_to_counterface(&self, vector: &Vector<F64x4>) -> Vector<F64x4> {
        let [x, y, z] = &self.columns;
        Vector::new(dot(x, vector), dot(y, vector), dot(z, vector))
    }

    /// Converts vectors of the counterface frame to the insert frame.
    #[inline(always)]
    pub fn turn_to_insert(&self, vector: &Vector<F64x4>) -> Vector<F64x4> {
        let [x, y, z] = &self.columns;
        scale_add(x, vector.x, &scale_add(y, vector.y, &(z * vector.z)))
    }
}

/// A twist of the counterface in its own frame, for four points at a time.
pub(crate) struct Twist4 {
    pub angular: Vector<F64x4>,
    linear: Vector<F64x4>,
}

impl Twist4 {
    /// Creates a twist that is the same for every point.
    pub fn new(twist: &Twist<Counterface, Counterface>) -> Self {
        Self {
            angular: twist.angular.map(F64x4::splat),
            linear: twist.linear.map(F64x4::splat),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_the_same_in_both_frames() {
        let rotation = nalgebra::Rotation3::new(Vec3::new(0.3, -0.8, 0.2)).into_inner();
        let pose = Pose::new(rotation, Vec3::new(4.0, -20.0, 3.0));
        let change = FrameChange::to_counterface(&pose);
        let twist = Twist::new(Vec3::new(1.0, 0.3, -2.0), Vec3::new(10.0, 3.0, 40.0));
        let wrench = Wrench::new(Vec3::new(5.0, 7.0, -1.0), Vec3::new(0.4, -3.0, 2.0));
        let power = change.wrench_back(&wrench).reaction().power(&twist);
        assert!((wrench.reaction().power(&change.twist(&twist)) - power).abs() < 1e-12);
    }

    #[test]
    fn verify_a_twist_in_the_counterface_frame_moves_the_same_material() {
        let rotation = nalgebra::Rotation3::new(Vec3::new(-0.2, 0.5, 0.9)).into_inner();
        let pose = Pose::new(rotation, Vec3::new(4.0, -20.0, 3.0));
        let twist: Twist = Twist::new(Vec3::new(1.0, 0.3, -2.0), Vec3::new(10.0, 3.0, 40.0));
        let own = FrameChange::to_counterface(&pose).twist(&twist);
        let place = Vec3::new(7.0, -25.0, 12.0);
        let velocity = twist.linear + twist.angular.cross(&place);
        let seen = own.linear + own.angular.cross(&pose.to_counterface(&place));
        assert!((pose.rotation * seen - velocity).norm() < 1e-12);
    }
}
