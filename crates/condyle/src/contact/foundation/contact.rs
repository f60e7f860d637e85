//! The contact of a rigid femur with an elastic foundation.

use super::{mean_overclosure::EdgeSlopes, peak::PeakSearch, settings::Foundation};
use crate::{
    contact::{
        broad_phase::BroadPhase,
        contact_law::Bodies,
        memory::{ContactCache, ContactMemory, ContactState},
        model::{ContactModel, ContactResult, Linearization, Response, Tangent},
        pressed::{NearBlocks, PressedBlocks},
        share_block::ShareBlock,
    },
    number::{F64x4, vector::dot},
    spatial::{FrameChange, Pose, Pose4, RelativeMotion, Twist4},
};

/// The contact of a femur with an insert as it is now, by a [`Foundation`], with a broad phase `B`.
///
/// What holds: a response depends on the motion alone, but for samples that are extrapolated
/// ([`Foundation::sample_reuse_mm`]), which change the force by less than a hundred-thousandth. The tangent is the
/// derivative of the response, summed up in single precision: right to six digits.
pub(super) struct FoundationContact<'a, B> {
    law: &'a Foundation,
    bodies: Bodies<'a>,
    nearby: NearBlocks<'a, B>,
    /// The blocks that touched at the last response.
    pressed: PressedBlocks,
    /// The edge slopes of their shares.
    slopes: Vec<EdgeSlopes<F64x4>>,
}

impl<'a, B: BroadPhase> FoundationContact<'a, B> {
    /// The contact of bodies, quicker where another left its cache for the insert less worn, under the
    /// same femur.
    pub fn after(cache: ContactCache, law: &'a Foundation, bodies: Bodies<'a>) -> Self {
        let nearby = NearBlocks::after(
            cache.into_inner(),
            bodies.femur,
            ShareBlock::of(bodies.insert, bodies.surface),
            law.sample_reuse_mm,
        );
        let pressed = PressedBlocks::none(bodies.surface, &nearby.blocks, law.coulomb());
        Self {
            law,
            bodies,
            nearby,
            pressed,
            slopes: Vec::new(),
        }
    }

    /// Finds the blocks that touch: those with a share of which a corner is overclosed.
    fn find_touching(&mut self, pose: &Pose, pose4: &Pose4) {
        let Self {
            nearby,
            pressed,
            slopes,
            ..
        } = self;
        pressed.near.clear();
        slopes.clear();
        nearby.find(
            pose,
            pose4,
            |cached, shares| {
                let normal = pose4.turn_to_insert(&cached.sample.normal);
                let slopes =
                    EdgeSlopes::new([dot(&normal, &shares.edge_a), dot(&normal, &shares.edge_b)]);
                (slopes.reach_mm(), slopes)
            },
            |near, edges| {
                pressed.near.push(near);
                slopes.push(edges);
            },
        );
    }

    fn peak_search(&self, pose: &Pose) -> PeakSearch<'_> {
        let Bodies {
            femur,
            insert,
            surface,
        } = self.bodies;
        PeakSearch {
            law: &self.law.pressure,
            femur,
            shares: &surface.shares,
            thickness_mm: insert.thickness_mm(),
            faces: insert.faces_around(),
            pose: Pose4::new(pose),
        }
    }
}

impl<B: BroadPhase> Linearization for FoundationContact<'_, B> {
    fn tangent(&self) -> Tangent {
        self.pressed.tangent()
    }
}

impl<B: BroadPhase> ContactModel for FoundationContact<'_, B> {
    fn node_count(&self) -> usize {
        self.bodies.surface.positions.len()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.nearby.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response<'_> {
        self.pressed.pose = motion.pose;
        let change = FrameChange::to_femur(&motion.pose);
        let pose = Pose4::new(&motion.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        self.find_touching(&motion.pose, &pose);
        let (law, slopes) = (self.law, &self.slopes);
        let (wrench, mean_slip) = self
            .pressed
            .press(&self.nearby.blocks, |place, near, shares| {
                law.press(&near.cached, &slopes[place], shares, &pose, &twist)
            });
        Response::new(change.wrench_back(&wrench), mean_slip, self)
    }

    fn land(&mut self, motion: &RelativeMotion) -> ContactResult {
        let touched = self.pressed.touched(&self.nearby.blocks, motion);
        ContactResult {
            peak_pressure_mpa: self.peak_search(&motion.pose).highest_mpa(&touched),
            touched,
        }
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        ContactMemory {
            state: ContactState::default(),
            cache: ContactCache::of(self.nearby.into_cache()),
        }
    }
}
