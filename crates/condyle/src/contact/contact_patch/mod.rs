//! The contact patch of a rigid counterface, for any pressure law: shares under pressure, their tractions and sums.
//!
//! `near_blocks` finds the blocks near the counterface and samples it there. `traction` holds the tractions on a block and the
//! sum of their derivatives. `peak` interpolates between the nodes and looks for the highest pressure there.

mod near_blocks;
mod peak;
mod traction;

pub(crate) use near_blocks::{CachedSample, NearBlock, NearBlocks};
pub(crate) use peak::{MIN_NODES, Quadratic, highest_mpa};
pub(crate) use traction::{Sliding, Tractions4};

use super::{
    broad_phase::ShareBlock,
    law::{Bodies, ContactSettings},
    model::{ContactCache, MAX_REGIONS, Tangent, TouchedNode},
};
use crate::{
    Vec3, Vector,
    number::{F64x4, LANES, Number, cross, dot, scale_add, vector_from_lanes, zero_vector},
    spatial::{
        FrameChange, Pose, Pose4, RelativeMotion, Twist, Twist4, Vec6, Wrench, WrenchByTwist, body,
    },
};
use traction::TangentSum;

/// The blocks under pressure at a response, and the tractions on them.
pub(crate) struct ContactPatch<'a> {
    pub nearby: NearBlocks<'a>,
    /// The blocks in contact, ascending.
    pub near: Vec<NearBlock>,
    tractions: Vec<Tractions4>,
    pub pose: Pose,
    settings: ContactSettings,
    /// The surface's own directions at the nodes of every block, anterior and lateral.
    directions: Vec<[Vector<F64x4>; 2]>,
}

#[derive(Clone, Copy)]
pub(crate) struct ContactNode {
    pub node: u32,
    /// The force along the counterface's normal, N, and its derivatives by a turn and a shift of the counterface in its frame.
    pub force_n: f64,
    pub by_motion: Vec6,
}

impl<'a> ContactPatch<'a> {
    /// Starts without contact, with the cache of another contact.
    pub fn new(
        bodies: Bodies<'a>,
        blocks: Vec<ShareBlock>,
        settings: ContactSettings,
        cache: ContactCache,
    ) -> Self {
        let directions = |block: &ShareBlock| {
            let at = block.nodes;
            let at = at.map(|node| bodies.surface.directions(node as usize));
            [0, 1].map(|which| vector_from_lanes(|lane| &at[lane][which]))
        };
        Self {
            near: Vec::new(),
            tractions: Vec::new(),
            pose: Pose::identity(),
            settings,
            directions: blocks.iter().map(directions).collect(),
            nearby: NearBlocks::new(cache.into_inner(), bodies.counterface, blocks, settings),
        }
    }

    /// Evaluates the `traction` on every near block, and returns the wrench on the insert about the counterface's origin, in the
    /// counterface frame, and the load-weighted mean slip of every region.
    pub fn evaluate(
        &mut self,
        mut traction: impl FnMut(usize, &NearBlock, &ShareBlock) -> Tractions4,
    ) -> (Wrench<body::Insert, body::Counterface>, [Vec3; MAX_REGIONS]) {
        let none = F64x4::splat(0.0);
        let mut wrench = [none; 6];
        let mut slips = [(none, zero_vector::<F64x4>()); MAX_REGIONS];
        self.tractions.clear();
        for (number, near) in self.near.iter().enumerate() {
            let shares = &self.nearby.blocks[near.block as usize];
            let tractions = traction(number, near, shares);
            let CachedSample { place, sample } = &near.cached;
            let force = tractions.force_n(&sample.normal, self.settings.friction);
            let moment = cross(place, &force);
            let own = [moment.x, moment.y, moment.z, force.x, force.y, force.z];
            for (sum, own) in wrench.iter_mut().zip(&own) {
                *sum += *own;
            }
            let load_n = tractions.pressure_mpa * tractions.area_mm2;
            let velocity = &tractions.sliding.velocity_mm_per_s;
            for ((loads, slip), is_in) in slips.iter_mut().zip(&shares.in_region) {
                let own_n = load_n * *is_in;
                *loads += own_n;
                *slip = scale_add(velocity, own_n, slip);
            }
            self.tractions.push(tractions);
        }
        let [mx, my, mz, fx, fy, fz] = wrench.map(F64x4::sum);
        // A region without load has no slip: its sum is zero, and so is the quotient.
        let mean = |(loads, slip): (F64x4, Vector<F64x4>)| {
            slip.map(F64x4::sum) / loads.sum().max(f64::MIN_POSITIVE)
        };
        (
            Wrench::new(Vec3::new(mx, my, mz), Vec3::new(fx, fy, fz)),
            slips.map(mean),
        )
    }

    pub fn tangent(&self) -> Tangent {
        let mut sum = TangentSum::new();
        // Two blocks of four fill the eight lanes of single precision; an odd last block is paired with no traction.
        for (near, tractions) in self.near.chunks(2).zip(self.tractions.chunks(2)) {
            let one = (&near[0].cached, &tractions[0]);
            let nothing = (one.0, &Tractions4::none());
            let other = near.get(1).map(|near| (&near.cached, &tractions[1]));
            sum.add(one, other.unwrap_or(nothing), self.settings.friction);
        }
        let (by_pose, by_twist) = sum.total();
        let change = FrameChange::to_counterface(&self.pose);
        Tangent {
            by_pose: change.derivative_back(&WrenchByTwist::new(by_pose)),
            by_twist: change.derivative_back(&WrenchByTwist::new(by_twist)),
        }
    }

    /// Returns the nodes in contact at a motion near that of the response.
    ///
    /// Over this short motion pressures change to first order, and covered areas stay constant.
    pub fn touched(&self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        let change = FrameChange::to_counterface(&self.pose);
        let moved = Twist4::new(&change.twist(&Twist::between(&self.pose, &motion.pose)));
        let twist = Twist4::new(&change.twist(&motion.twist));
        let pose = Pose4::new(&self.pose);
        let mut touched = Vec::with_capacity(LANES * self.near.len());
        for (near, tractions) in self.near.iter().zip(&self.tractions) {
            let (shares, [anterior, lateral]) = (
                &self.nearby.blocks[near.block as usize],
                &self.directions[near.block as usize],
            );
            let CachedSample { place, sample } = &near.cached;
            let change_n = tractions.load_change_n(place, &moved);
            // Unused lanes have no area.
            let area_mm2 = Number::max(tractions.area_mm2, F64x4::splat(f64::MIN_POSITIVE));
            let pressure_mpa = tractions.pressure_mpa + change_n / area_mm2;
            let tolerance = self.settings.slip_tolerance_mm_per_s;
            let there = Tractions4 {
                pressure_mpa: Number::max(pressure_mpa, F64x4::splat(0.0)),
                sliding: Sliding::new(&twist.velocity(place), &sample.normal, tolerance),
                ..*tractions
            };
            let force = there.force_n(&sample.normal, self.settings.friction);
            let force = pose.turn_to_insert(&force);
            let sliding = pose.turn_to_insert(&there.sliding.velocity_mm_per_s);
            let sliding = [dot(&sliding, anterior), dot(&sliding, lateral)];
            for (lane, &node) in shares.nodes.iter().enumerate() {
                let pressure_mpa = there.pressure_mpa.lane(lane);
                if pressure_mpa * shares.area_mm2.lane(lane) > 0.0 {
                    touched.push(TouchedNode {
                        node,
                        region: shares.regions[lane],
                        pressure_mpa,
                        covered_mm2: there.covered_mm2.lane(lane),
                        force_n: force.map(|lanes| lanes.lane(lane)),
                        sliding_mm_per_s: sliding.map(|lanes| lanes.lane(lane)),
                        along_mm: [0.0; 2],
                    });
                }
            }
        }
        touched
    }

    /// Returns the forces on the nodes in contact, extrapolated over a short motion of the counterface since the response.
    pub fn nodes(&self, moved: &Twist<body::Counterface, body::Counterface>) -> Vec<ContactNode> {
        let mut nodes = Vec::new();
        for (near, tractions) in self.near.iter().zip(&self.tractions) {
            let shares = &self.nearby.blocks[near.block as usize];
            let force_n = tractions.pressure_mpa * tractions.area_mm2;
            let shift = &tractions.load_by_motion;
            let turn = cross(&near.cached.place, shift) + tractions.load_by_turn;
            let by: [F64x4; 6] = [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
            for (lane, &node) in shares.nodes.iter().enumerate() {
                let own_n = force_n.lane(lane);
                if own_n * shares.area_mm2.lane(lane) > 0.0 {
                    let by_motion = Vec6::from_fn(|motion, _| by[motion].lane(lane));
                    nodes.push(ContactNode {
                        node,
                        force_n: (own_n + by_motion.dot(&moved.numbers())).max(0.0),
                        by_motion,
                    });
                }
            }
        }
        nodes
    }
}
