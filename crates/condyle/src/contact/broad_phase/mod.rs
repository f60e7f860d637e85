//! The broad phase: the blocks of nodes that may touch, under which alone the contact samples the femur.

mod separations;
#[cfg(test)]
mod tests;

pub(crate) use separations::SeparationBound;

use std::any::Any;

use super::share_block::ShareBlock;
use crate::spatial::Pose;
use separations::{BlockPlaces, BlockWear, LastWear, Separations};

/// The search for the blocks of nodes that may touch. The results are the same.
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
pub(crate) trait BroadPhase: Any + Send + Sync + Sized {
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

/// Names every block.
pub(crate) struct BruteForce {
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

/// Lower bounds on the separation of every block at every increment of the cycle.
///
/// A block that was found apart is no candidate before the femur can have come near enough. What touches
/// is exactly what brute force would find. A cycle after, and with a little wear, the femur
/// is within tenths of a millimetre of where it was, and so every increment goes on from what was known
/// there; where that does not tell, from what the increment before has just found. Hardly any block is a
/// candidate but those that touch.
pub(crate) struct Coherent {
    /// The bounds at the increments so far, but for the present one.
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
    /// Takes the bounds at an increment; none if they are older than the last wear but one.
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
            places: BlockPlaces::from_blocks(blocks),
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
        self.places = BlockPlaces::from_blocks(after);
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
