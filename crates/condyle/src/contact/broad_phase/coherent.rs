//! Which shares may touch: four are looked at again only when they could have come near.

use super::{
    clearance::Clearance,
    ground::{Ground, LastWear, Wear},
    shares::ShareBlock,
    standoff::Standoff,
};
use crate::{
    Vector,
    number::F64x4,
    spatial::{Pose, Pose4},
};

/// How far every four shares are from touching, at least, at every increment of the cycle.
///
/// NodeBlock shares that were seen apart need no look before the femur has come near enough. What is left
/// is exactly what a search over all nodes would find. A cycle after, and with a little wear, the
/// femur is within tenths of a millimetre of where it was, and so every increment goes on from what
/// was known there; where that is not enough, from what the increment before has just found. Hardly
/// any share is looked at but those that touch.
pub(super) struct Nearness {
    /// What is known at the increments come to so far, but for the one that it is now.
    standoffs: Vec<Option<Standoff>>,
    increment: usize,
    /// The increment before, until the first find at this one.
    beside: Option<usize>,
    now: Standoff,
    ground: Vec<Ground>,
    last_wear: LastWear,
    /// The node_blocks that may touch.
    due: Vec<u32>,
}

impl Nearness {
    /// Nothing is known.
    pub fn new(shares: &[ShareBlock]) -> Self {
        Self {
            standoffs: Vec::new(),
            increment: 0,
            beside: None,
            now: Standoff::new(shares.len()),
            ground: Ground::of(shares),
            last_wear: LastWear {
                number: 0,
                eights: Vec::new(),
            },
            due: Vec::new(),
        }
    }

    /// Goes on from what is known at another increment; at one never come to, from what is known
    /// now.
    pub fn begin_increment(&mut self, increment: usize) {
        if increment == self.increment {
            return;
        }
        let most = increment.max(self.increment);
        if most >= self.standoffs.len() {
            self.standoffs.resize(most + 1, None);
        }
        let kept = self.kept(increment);
        self.beside = kept.is_some().then_some(self.increment);
        let next = kept.unwrap_or_else(|| self.now.clone());
        let left = std::mem::replace(&mut self.now, next);
        self.standoffs[self.increment] = Some(left);
        self.increment = increment;
    }

    /// What is known at an increment; none if it is older than the last wear but one.
    fn kept(&mut self, increment: usize) -> Option<Standoff> {
        let standoff = self.standoffs[increment].take()?;
        (standoff.worn() + 1 >= self.last_wear.number).then_some(standoff)
    }

    /// Lists the node_blocks that may touch under a femur at a pose, each with the places of its centres
    /// there.
    ///
    /// They are found first and looked at after: the processor goes through two short loops faster
    /// than through a long one, where every step waits for the one before.
    pub fn find_due(
        &mut self,
        shares: &[ShareBlock],
        to: &Pose,
        pose: &Pose4,
        due: &mut Vec<(u32, Vector<F64x4>)>,
    ) {
        let beside = self.beside.take();
        let beside = beside.and_then(|beside| self.standoffs[beside].as_ref());
        self.now
            .follow(to, &self.ground, &self.last_wear, beside, &mut self.due);
        due.clear();
        for &four in &self.due {
            due.push((four, pose.to_femur(&shares[four as usize].centre)));
        }
    }

    /// NodeBlock touch: they are always due.
    #[inline(always)]
    pub fn touches(&mut self, four: u32) {
        self.now.touches(four);
    }

    /// NodeBlock were seen apart.
    #[inline(always)]
    pub fn is_apart(&mut self, four: u32, clearance: &Clearance) {
        self.now.set(four, clearance);
    }

    /// What is still known when the shares have worn from what they were before.
    pub fn worn(mut self, before: &[ShareBlock], shares: &[ShareBlock]) -> Self {
        if self.now.worn() < self.last_wear.number {
            self.now = Standoff::new(shares.len());
        }
        self.last_wear = LastWear {
            number: self.last_wear.number + 1,
            eights: Wear::between(before, shares),
        };
        self.ground = Ground::of(shares);
        self
    }
}
