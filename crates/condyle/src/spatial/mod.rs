//! Poses, twists and wrenches that say of what they are and in which frame.
//!
//! There are two bodies: the [insert](body::Insert) and the [femur](body::Femur). Each carries a frame, and
//! so a body's name stands for its frame too. A quantity's type says what it is of and where its
//! numbers are read: [`Twist<Femur, Insert>`](Twist) is the femur's motion past the insert in the insert frame,
//! [`Wrench<Insert, Femur>`](Wrench) acts on the insert and is written in the femoral frame. Only a wrench on a body
//! does work on a twist of that same body, so a forgotten sign or frame does not compile:
//!
//! ```compile_fail
//! use condyle::spatial::{Twist, Wrench, body::{Femur, Insert}};
//! let (on_insert, of_femur) = (Wrench::<Insert, Insert>::zero(), Twist::<Femur, Insert>::zero());
//! on_insert.power(&of_femur);
//! ```
//!
//! ```
//! use condyle::{Vec3, spatial::{Twist, Wrench, body::{Femur, Insert}}};
//! let on_insert = Wrench::<Insert, Insert>::new(Vec3::zeros(), Vec3::new(0.0, -100.0, 0.0));
//! let sinking = Twist::<Femur, Insert>::new(Vec3::zeros(), Vec3::new(0.0, -2.0, 0.0));
//! // What presses the insert down by 100 N pushes the femur up: it takes 200 N mm/s from it.
//! assert_eq!(on_insert.reaction().power(&sinking), -200.0);
//! ```

pub mod body;
mod frame_change;
mod motion;
mod pose;
mod side_by_side;
mod twist;
mod wrench;

pub use frame_change::FrameChange;
pub use motion::RelativeMotion;
pub use pose::Pose;
pub use side_by_side::{Pose4, Twist4};
pub use twist::Twist;
pub use wrench::{Wrench, WrenchByTwist};

/// Six numbers: three of turning or of a moment, then three of shifting or of a force.
pub type Vec6 = nalgebra::Vector6<f64>;
/// A derivative of six numbers by six others.
pub type Mat6 = nalgebra::Matrix6<f64>;
