//! The quick path: a block is a candidate only when the femur can have come near it.

use super::{
    block_places::{BlockPlaces, BlockWear, LastWear},
    interface::BroadPhase,
    separation_bound::SeparationBound,
    separations::Separations,
};
use crate::{contact::share_block::ShareBlock, spatial::Pose};

/// How far every block is from touching, at least, at every increment of the cycle.
///
/// A block that was found apart is no candidate before the femur can have come near enough. What touches
/// is exactly what brute force would find. A cycle after, and with a little wear, the femur
/// is within tenths of a millimetre of where it was, and so every increment goes on from what was known
/// there; where that does not tell, from what the increment before has just found. Hardly any block is a
/// candidate but those that touch.
pub(in crate::contact) struct Coherent {
    /// What is known at the increments come to so far, but for the one that it is now.
    kept: Vec<Option<Separations>>,
    increment: usize,
    /// The increment before, until the first pose of this one.
    neighbour: Option<usize>,
    now: Separations,
    places: Vec<BlockPlaces>,
    last_wear: LastWear,
    candidates: Vec<u32>,
}

impl Coherent {
    /// What is known at an increment; none if it is older than the last wear but one.
    fn take_kept(&mut self, increment: usize) -> Option<Separations> {
        let kept = self.kept[increment].take()?;
        (kept.worn() + 1 >= self.last_wear.number).then_some(kept)
    }
}

impl BroadPhase for Coherent {
    fn new(blocks: &[ShareBlock]) -> Self {
        Self {
            kept: Vec::new(),
            increment: 0,
            neighbour: None,
            now: Separations::new(blocks.len()),
            places: BlockPlaces::of(blocks),
            last_wear: LastWear::default(),
            candidates: Vec::new(),
        }
    }

    fn worn(mut self, before: &[ShareBlock], after: &[ShareBlock]) -> Self {
        if before.len() != after.len() {
            return Self::new(after);
        }
        if self.now.worn() < self.last_wear.number {
            self.now = Separations::new(after.len());
        }
        self.last_wear = LastWear {
            number: self.last_wear.number + 1,
            eights: BlockWear::between(before, after),
        };
        self.places = BlockPlaces::of(after);
        self
    }

    fn begin_increment(&mut self, increment: usize) {
        if increment == self.increment {
            return;
        }
        let most = increment.max(self.increment);
        if most >= self.kept.len() {
            self.kept.resize(most + 1, None);
        }
        let kept = self.take_kept(increment);
        self.neighbour = kept.is_some().then_some(self.increment);
        let next = kept.unwrap_or_else(|| self.now.clone());
        let left = std::mem::replace(&mut self.now, next);
        self.kept[self.increment] = Some(left);
        self.increment = increment;
    }

    fn candidates(&mut self, pose: &Pose) -> &[u32] {
        let neighbour = self.neighbour.take();
        self.now.follow(
            pose,
            &self.places,
            &self.last_wear,
            neighbour.and_then(|increment| self.kept[increment].as_ref()),
            &mut self.candidates,
        );
        &self.candidates
    }

    #[inline(always)]
    fn touches(&mut self, block: u32) {
        self.now.touches(block);
    }

    #[inline(always)]
    fn is_apart(&mut self, block: u32, bound: impl FnOnce() -> SeparationBound) {
        self.now.set(block, &bound());
    }
}
