//! The femur's motion relative to the insert.

use super::{Pose, Twist};

/// Pose and velocity of the femur relative to the insert, in the insert frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeMotion {
    /// Where the femur is.
    pub pose: Pose,
    /// How fast it moves, rad/s and mm/s.
    pub twist: Twist,
}

impl RelativeMotion {
    /// A femur that stands still at a pose.
    pub fn at_rest(pose: Pose) -> Self {
        let twist = Twist::zero();
        Self { pose, twist }
    }
}
