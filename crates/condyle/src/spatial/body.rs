//! The bodies of a joint, as words in types.

use std::fmt::Debug;

/// A body, and the frame that is fixed to it.
pub trait Body: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// The body that it articulates with.
    type Other: Body<Other = Self>;
}

/// The polyethylene: the tibial insert of a knee.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Insert {}

/// The metal that slides on it: the femoral component of a knee.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Femur {}

impl Body for Insert {
    type Other = Femur;
}

impl Body for Femur {
    type Other = Insert;
}
