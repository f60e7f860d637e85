//! What a contact asks of a broad phase.

use std::any::Any;

use super::separation_bound::SeparationBound;
use crate::{contact::share_block::ShareBlock, spatial::Pose};

/// How the blocks of nodes that may touch are found. The results are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Search {
    /// Every block is a candidate, every time: the plain path, and the reference.
    BruteForce,
    /// A block is a candidate once the femur can have come near it, by bounds that are carried along.
    #[default]
    Coherent,
}

/// Finds the blocks that may touch under a femur at a pose.
///
/// It may name blocks that do not touch, and leaves out none that does. The contact samples the femur
/// under what it names and says what it found, block by block; a broad phase may remember that.
pub(in crate::contact) trait BroadPhase: Any + Send + Sync + Sized {
    /// One that knows nothing of these blocks yet.
    fn new(blocks: &[ShareBlock]) -> Self;

    /// One that goes on from what this one knew, now that the blocks have worn from what they were.
    fn worn(self, before: &[ShareBlock], after: &[ShareBlock]) -> Self;

    /// The next poses are of this increment of the cycle, near those of the same increment a cycle
    /// before.
    fn begin_increment(&mut self, increment: usize);

    /// The blocks that may touch, ascending.
    fn candidates(&mut self, pose: &Pose) -> &[u32];

    /// A candidate touches.
    fn touches(&mut self, block: u32);

    /// A candidate is apart, by no less than `bound` says.
    fn is_apart(&mut self, block: u32, bound: impl FnOnce() -> SeparationBound);
}
