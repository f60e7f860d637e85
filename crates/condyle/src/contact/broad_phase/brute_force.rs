//! The plain path: every block may touch.

use super::{interface::BroadPhase, separation_bound::SeparationBound};
use crate::{contact::share_block::ShareBlock, spatial::Pose};

/// Names every block.
pub(in crate::contact) struct BruteForce {
    all: Vec<u32>,
}

impl BroadPhase for BruteForce {
    fn new(blocks: &[ShareBlock]) -> Self {
        let all = (0..blocks.len() as u32).collect();
        Self { all }
    }

    fn worn(self, _: &[ShareBlock], after: &[ShareBlock]) -> Self {
        Self::new(after)
    }

    fn begin_increment(&mut self, _: usize) {}

    fn candidates(&mut self, _: &Pose) -> &[u32] {
        &self.all
    }

    fn touches(&mut self, _: u32) {}

    fn is_apart(&mut self, _: u32, _: impl FnOnce() -> SeparationBound) {}
}
