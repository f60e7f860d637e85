//! Blocks of shares under pressure, and what they add up to.

use super::{
    landing::{Directions4, ShortWay},
    near_blocks::NearBlock,
    sums::{RegionSlips, WrenchSum},
    tangent_sum::TangentSum,
    traction::{Coulomb, Tractions4},
};
use crate::{
    Vec3,
    contact::{
        model::{MAX_REGIONS, Tangent, TouchedNode},
        share_block::ShareBlock,
    },
    geometry::ArticulatingSurface,
    number::LANES,
    spatial::{FrameChange, Pose, RelativeMotion, Wrench, WrenchByTwist, body},
};

/// The blocks that press at a response, and the forces on them.
pub(in crate::contact) struct PressedBlocks {
    /// The blocks near the femur, ascending.
    pub near: Vec<NearBlock>,
    /// What presses each of them.
    tractions: Vec<Tractions4>,
    /// Where the femur is.
    pub pose: Pose,
    friction: Coulomb,
    /// The surface's own directions at the nodes of every block.
    directions: Vec<Directions4>,
}

impl PressedBlocks {
    /// Nothing presses yet.
    pub fn none(surface: &ArticulatingSurface, blocks: &[ShareBlock], friction: Coulomb) -> Self {
        let directions = blocks.iter().map(|block| Directions4::new(surface, block));
        Self {
            near: Vec::new(),
            tractions: Vec::new(),
            pose: Pose::identity(),
            friction,
            directions: directions.collect(),
        }
    }

    /// Presses the blocks, each by the `traction` of its place in the list and its shares; the wrench on the insert in
    /// the femoral frame, and how regions slip.
    pub fn press(
        &mut self,
        blocks: &[ShareBlock],
        mut traction: impl FnMut(usize, &NearBlock, &ShareBlock) -> Tractions4,
    ) -> (Wrench<body::Insert, body::Femur>, [Vec3; MAX_REGIONS]) {
        let mut total = WrenchSum::new();
        let mut slips = RegionSlips::new();
        self.tractions.clear();
        for (place, near) in self.near.iter().enumerate() {
            let shares = &blocks[near.block as usize];
            let pressed = traction(place, near, shares);
            let force_n = pressed.force_n(&near.cached.sample.normal, self.friction.coefficient);
            total.add(&near.cached.place, &force_n);
            slips.add(&shares.in_region, &pressed);
            self.tractions.push(pressed);
        }
        (total.total(), slips.means())
    }

    /// The blocks that press, and what presses them.
    pub fn loaded(&self) -> impl Iterator<Item = (&NearBlock, &Tractions4)> {
        self.near.iter().zip(&self.tractions)
    }

    /// How the wrench changes.
    pub fn tangent(&self) -> Tangent {
        let mut sum = TangentSum::new();
        for (near, tractions) in self.near.chunks(2).zip(self.tractions.chunks(2)) {
            let one = (&near[0].cached, &tractions[0]);
            let nothing = (one.0, &Tractions4::none());
            let other = near.get(1).map(|near| (&near.cached, &tractions[1]));
            sum.add(one, other.unwrap_or(nothing), self.friction.coefficient);
        }
        let (by_pose, by_twist) = sum.total();
        let change = FrameChange::to_femur(&self.pose);
        Tangent {
            by_pose: change.derivative_back(&WrenchByTwist::new(by_pose)),
            by_twist: change.derivative_back(&WrenchByTwist::new(by_twist)),
        }
    }

    /// The nodes in contact at a motion near that of the response.
    pub fn touched(&self, blocks: &[ShareBlock], motion: &RelativeMotion) -> Vec<TouchedNode> {
        let way = ShortWay::between(&self.pose, motion);
        let mut touched = Vec::with_capacity(LANES * self.near.len());
        for pressed in self.near.iter().zip(&self.tractions) {
            let block = pressed.0.block as usize;
            let place = (&blocks[block], &self.directions[block]);
            way.land(self.friction, pressed, place, &mut touched);
        }
        touched
    }
}
