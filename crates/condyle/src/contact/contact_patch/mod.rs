//! Shares under pressure, whatever presses them: what all contacts of a rigid femur have in common.
//!
//! The blocks that come near (`near_blocks`) and their samples of the femur (`cached_sample`), their loads and
//! how they rub (`traction`), what these add up to (`pressed_blocks`: `sums`, `tangent_sum`), and what every
//! node feels where an increment ends (`landing`). Between the nodes a quantity is a quadratic (`quadratic`), and the
//! highest pressure is looked for there (`peak`).

mod near_blocks;
mod peak;
mod traction;

pub(crate) use near_blocks::CachedSample;
pub(crate) use near_blocks::{NearBlock, NearBlocks};
pub(crate) use peak::Quadratic;
pub(crate) use peak::{MIN_NODES, highest_mpa};
pub(crate) use traction::{Coulomb, Sliding, Tractions4};

use super::{
    model::{MAX_REGIONS, Tangent, TouchedNode},
    share_block::ShareBlock,
};
use crate::{
    Vec3, Vector,
    geometry::ArticulatingSurface,
    number::{F64x4, LANES, Number, dot, vector_from_lanes},
    spatial::{
        FrameChange, Pose, Pose4, RelativeMotion, Twist, Twist4, Wrench, WrenchByTwist, body,
    },
};
use traction::{RegionSlips, TangentSum, WrenchSum};

/// The blocks that press at a response, and the forces on them.
pub(crate) struct ContactPatch {
    /// The blocks near the femur, ascending.
    pub near: Vec<NearBlock>,
    /// The tractions on each of them.
    tractions: Vec<Tractions4>,
    /// The pose of the femur.
    pub pose: Pose,
    friction: Coulomb,
    /// The surface's own directions at the nodes of every block.
    directions: Vec<Directions4>,
}

impl ContactPatch {
    /// Nothing presses yet.
    pub fn new(surface: &ArticulatingSurface, blocks: &[ShareBlock], friction: Coulomb) -> Self {
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

    /// Returns the derivatives of the wrench.
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
            way.add_touched(self.friction, pressed, place, &mut touched);
        }
        touched
    }
}

/// The surface's own directions at the four nodes of a block.
pub(crate) struct Directions4([Vector<F64x4>; 2]);

impl Directions4 {
    /// Anterior along the surface, then lateral along it.
    pub fn new(surface: &ArticulatingSurface, shares: &ShareBlock) -> Self {
        let at = shares.nodes.map(|node| surface.directions(node as usize));
        Self([0, 1].map(|which| vector_from_lanes(|lane| &at[lane][which])))
    }
}

/// A short way from the last response to where the increment ends, to first order.
pub(crate) struct ShortWay {
    moved: Twist4,
    twist: Twist4,
    pose: Pose4,
}

/// A block of shares at the end of an increment.
struct Landed4 {
    pressure_mpa: F64x4,
    covered_mm2: F64x4,
    /// In the insert frame.
    force_n: Vector<F64x4>,
    /// In the surface's own directions.
    sliding_mm_per_s: [F64x4; 2],
}

impl ShortWay {
    /// From a response at a pose to a motion near it.
    pub fn between(from: &Pose, to: &RelativeMotion) -> Self {
        let change = FrameChange::to_femur(from);
        Self {
            moved: Twist4::new(&change.twist(&Twist::between(from, &to.pose))),
            twist: Twist4::new(&change.twist(&to.twist)),
            pose: Pose4::new(from),
        }
    }

    /// Adds the nodes of a block that press at its end.
    #[inline(always)]
    pub fn add_touched(
        &self,
        friction: Coulomb,
        (near, tractions): (&NearBlock, &Tractions4),
        (shares, directions): (&ShareBlock, &Directions4),
        touched: &mut Vec<TouchedNode>,
    ) {
        let landed = self.landed(friction, near, tractions, directions);
        landed.add(shares, touched);
    }

    /// A block at the end: pressures follow the motion to first order, the covered area stays.
    #[inline(always)]
    fn landed(
        &self,
        friction: Coulomb,
        near: &NearBlock,
        tractions: &Tractions4,
        directions: &Directions4,
    ) -> Landed4 {
        let CachedSample { place, sample } = &near.cached;
        let change_n = tractions.load_change_n(place, &self.moved);
        let area_mm2 = Number::max(tractions.area_mm2, F64x4::splat(f64::MIN_POSITIVE));
        let pressure_mpa = tractions.pressure_mpa + change_n / area_mm2;
        let landed = Tractions4 {
            pressure_mpa: Number::max(pressure_mpa, F64x4::splat(0.0)),
            sliding: Sliding::new(
                &self.twist.velocity(place),
                &sample.normal,
                friction.slip_tolerance_mm_per_s,
            ),
            ..*tractions
        };
        let force_n = landed.force_n(&sample.normal, friction.coefficient);
        let sliding = self.pose.turn_to_insert(&landed.sliding.velocity_mm_per_s);
        let [anterior, lateral] = &directions.0;
        Landed4 {
            pressure_mpa: landed.pressure_mpa,
            covered_mm2: landed.covered_mm2,
            force_n: self.pose.turn_to_insert(&force_n),
            sliding_mm_per_s: [dot(&sliding, anterior), dot(&sliding, lateral)],
        }
    }
}

impl Landed4 {
    /// Adds those of a block that press.
    #[inline(always)]
    fn add(&self, shares: &ShareBlock, touched: &mut Vec<TouchedNode>) {
        for (lane, &node) in shares.nodes.iter().enumerate() {
            let pressure_mpa = self.pressure_mpa.lane(lane);
            if pressure_mpa * shares.area_mm2.lane(lane) > 0.0 {
                let force = &self.force_n;
                let [anterior, lateral] = &self.sliding_mm_per_s;
                touched.push(TouchedNode {
                    node,
                    region: shares.regions[lane],
                    pressure_mpa,
                    covered_mm2: self.covered_mm2.lane(lane),
                    force_n: Vec3::new(force.x.lane(lane), force.y.lane(lane), force.z.lane(lane)),
                    sliding_mm_per_s: [anterior.lane(lane), lateral.lane(lane)],
                    along_mm: [0.0; 2],
                });
            }
        }
    }
}
