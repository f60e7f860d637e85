//! Contact between femur and insert: one interface, several models.

mod clearance;
mod foundation;
mod ground;
mod history;
mod law;
mod motion;
mod nearness;
mod partial;
mod peak;
mod quadratic;
mod seen;
mod shares;
mod standoff;
mod tangent;
mod traction;

pub use foundation::{Former, Foundation, FoundationSettings};
pub use history::{CycleHistory, Moment, NodeHistory};
pub use law::{PressureLaw, PressureTable, PressureTableError, confined_modulus};
pub use motion::{Mat6, Pose, RelativeMotion, Vec6, cross_matrix};

use crate::Vec3;

/// How the wrench of the contact changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// Derivative of the wrench by a small motion of the femur (turn, rad, then translation of
    /// its material at the insert's origin, mm).
    pub by_pose: Mat6,
    /// Derivative of the wrench by the twist.
    pub by_twist: Mat6,
}

/// A surface node in contact; vectors in the insert frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchedNode {
    /// Number of the surface node.
    pub node: u32,
    /// Whether it is on the medial side.
    pub is_medial: bool,
    /// Mean pressure on the node's share of the surface, MPa.
    pub pressure_mpa: f64,
    /// Area of the part of the share that presses, mm2.
    pub covered_mm2: f64,
    /// Force on the insert there, N.
    pub force_n: Vec3,
    /// Velocity of the femur's surface past the insert's in the surface's own directions, anterior
    /// along the surface, then lateral, mm/s.
    pub sliding_mm_per_s: [f64; 2],
}

/// A model of contact: the machine sees this, never a mesh.
pub trait ContactModel {
    /// The next motions are of this increment of the cycle, much like those of the same increment a
    /// cycle before.
    ///
    /// A hint that makes a model quicker, and changes none of its answers.
    fn begin_increment(&mut self, _increment: usize) {}

    /// Wrench on the insert about its origin at a relative motion: moment, N mm, then force, N; in
    /// the insert frame.
    ///
    /// The answer depends on the motion alone and not on the calls before, but for what a model
    /// says it rounds.
    fn respond(&mut self, motion: &RelativeMotion) -> Vec6;

    /// The exact derivatives of the wrench at the last [`ContactModel::respond`].
    fn tangent(&self) -> Tangent;

    /// Velocity of the femur's surface past the insert's at the last [`ContactModel::respond`], the
    /// mean over each side weighted by load, mm/s: medial, then lateral; in the femoral frame.
    fn mean_slip(&self) -> [Vec3; 2];

    /// How many surface nodes there are.
    fn node_count(&self) -> usize;

    /// The nodes in contact at a motion, each once and always in the same order: that of the last
    /// [`ContactModel::respond`], or one so near that loads and speeds may be taken along to first
    /// order.
    fn touched(&mut self, motion: &RelativeMotion) -> Vec<TouchedNode>;

    /// Highest pressure at a motion, MPa, at nodes and between them, where `touched` are the nodes in
    /// contact: not below the largest mean over a node's share.
    fn peak_pressure_mpa(&self, motion: &RelativeMotion, touched: &[TouchedNode]) -> f64;
}

impl<C: ContactModel + ?Sized> ContactModel for Box<C> {
    fn begin_increment(&mut self, increment: usize) {
        (**self).begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
        (**self).respond(motion)
    }

    fn tangent(&self) -> Tangent {
        (**self).tangent()
    }

    fn mean_slip(&self) -> [Vec3; 2] {
        (**self).mean_slip()
    }

    fn node_count(&self) -> usize {
        (**self).node_count()
    }

    fn touched(&mut self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        (**self).touched(motion)
    }

    fn peak_pressure_mpa(&self, motion: &RelativeMotion, touched: &[TouchedNode]) -> f64 {
        (**self).peak_pressure_mpa(motion, touched)
    }
}
