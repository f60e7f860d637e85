//! The broad phase: the blocks of nodes that may touch. Only under these does the contact sample the counterface.

mod separations;
mod share_block;
#[cfg(test)]
mod tests;

pub(crate) use separations::SeparationBound;
pub(crate) use share_block::ShareBlock;

use crate::spatial::Pose;
use separations::{BlockPlaces, BlockWear, LastWear, Separations};

/// The search for the blocks of nodes that may touch. The results are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Search {
    /// Every block is always a candidate: the plain path, and the reference.
    BruteForce,
    /// A block is a candidate once the counterface can have come near it, by bounds that are carried from pose to pose.
    #[default]
    Coherent,
}

/// Finds the blocks that may touch under a counterface at a pose.
///
/// The candidates may include blocks that do not touch, and leave out none that does. The contact samples the counterface
/// under every candidate and reports whether it touches or is apart.
///
/// By brute force every block is a candidate. The coherent search keeps a lower bound on the separation of every block
/// at every increment of the cycle. One cycle later, and with a little wear, the counterface is within tenths of a millimetre
/// of where it was, so every increment starts from the bounds found there before; where these do not suffice, from those
/// of the increment before. Hardly any block is then a candidate but those that touch.
pub(crate) struct BroadPhase {
    pub search: Search,
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

impl BroadPhase {
    /// Starts a search with no bounds: every block is a candidate.
    pub fn new(search: Search, blocks: &[ShareBlock]) -> Self {
        Self {
            search,
            kept: Vec::new(),
            increment: 0,
            neighbour: None,
            now: Separations::new(blocks.len()),
            places: BlockPlaces::from_blocks(blocks),
            last_wear: LastWear::default(),
            candidates: (0..blocks.len() as u32).collect(),
        }
    }

    /// Resumes the search after the blocks have worn, reusing its bounds where that is possible.
    pub fn worn(mut self, before: &[ShareBlock], after: &[ShareBlock]) -> Self {
        if before.len() != after.len() || self.search == Search::BruteForce {
            return Self::new(self.search, after);
        }
        // Only the last wear is kept: bounds that are older than it cannot be carried to the new surface.
        if self.now.worn < self.last_wear.number {
            self.now = Separations::new(after.len());
        }
        self.last_wear = LastWear {
            number: self.last_wear.number + 1,
            eights: BlockWear::between(before, after),
        };
        self.places = BlockPlaces::from_blocks(after);
        self
    }

    /// Announces poses of an increment of the cycle, near those of the same increment a cycle before.
    pub fn begin_increment(&mut self, increment: usize) {
        if increment == self.increment || self.search == Search::BruteForce {
            return;
        }
        // Slots appear as increments do: the number of increments of a cycle is not known here.
        let most = increment.max(self.increment);
        if most >= self.kept.len() {
            self.kept.resize(most + 1, None);
        }
        let kept = self.kept[increment].take();
        let kept = kept.filter(|kept| kept.worn + 1 >= self.last_wear.number);
        self.neighbour = kept.is_some().then_some(self.increment);
        let next = kept.unwrap_or_else(|| self.now.clone());
        let left = std::mem::replace(&mut self.now, next);
        self.kept[self.increment] = Some(left);
        self.increment = increment;
    }

    /// Returns the blocks that may touch, ascending.
    pub fn candidates(&mut self, pose: &Pose) -> &[u32] {
        if self.search == Search::Coherent {
            let neighbour = self.neighbour.take();
            self.now.follow(
                pose,
                &self.places,
                &self.last_wear,
                neighbour.and_then(|increment| self.kept[increment].as_ref()),
                &mut self.candidates,
            );
        }
        &self.candidates
    }

    /// Reports that a candidate touches.
    #[inline(always)]
    pub fn touches(&mut self, block: u32) {
        self.now.touches(block);
    }

    /// Reports that a candidate is apart, by no less than `bound`.
    #[inline(always)]
    pub fn is_apart(&mut self, block: u32, bound: impl FnOnce() -> SeparationBound) {
        if self.search == Search::Coherent {
            self.now.set(block, &bound());
        }
    }
}
