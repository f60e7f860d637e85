//! The contact of a rigid femur with an elastic foundation.

use super::{
    active_block::ActiveBlock,
    cached_sample::CachedSample,
    landing::{Directions4, ShortWay},
    mean_overclosure::EdgeSlopes,
    peak::PeakSearch,
    settings::Foundation,
    sums::{RegionSlips, WrenchSum},
    tangent_sum::TangentSum,
    traction::Tractions4,
};
use crate::{
    Vec3, Vector,
    contact::{
        broad_phase::{BroadPhase, SeparationBound},
        contact_law::Bodies,
        memory::{ContactCache, ContactMemory, ContactState},
        model::{
            ContactModel, Landing, Linearization, MOST_REGIONS, Response, Tangent, TouchedNode,
        },
        share_block::ShareBlock,
    },
    number::{F64x4, LANES, Number, vector::dot},
    spatial::{FrameChange, Pose, Pose4, RelativeMotion, Twist4, Wrench, WrenchByTwist, body},
};

/// What one contact knew of which blocks come near, and when; it makes the contact after it quicker.
struct Cache<B> {
    blocks: Vec<ShareBlock>,
    search: B,
}

/// The contact of a femur with an insert as it is now, by a [`Foundation`], with a broad phase `B`.
///
/// What holds: a response depends on the motion alone, but for samples that are extrapolated
/// ([`Foundation::sample_reuse_mm`]), which change the force by less than a hundred-thousandth. The tangent is the
/// derivative of the response, summed up in single precision: right to six digits.
pub(super) struct FoundationContact<'a, B> {
    law: &'a Foundation,
    bodies: Bodies<'a>,
    blocks: Vec<ShareBlock>,
    directions: Vec<Directions4>,
    search: B,
    /// Every block's last sample of the femur, and the number of the response at which it touched last.
    cached: Vec<CachedSample>,
    touched_at: Vec<u64>,
    /// The number of the last response: the first is 2, and none has touched at the one before it.
    response: u64,
    /// The blocks that may touch, and the places of their centres in the femoral frame.
    candidates: Vec<(u32, Vector<F64x4>)>,
    /// The blocks that touched at the last response, and what pressed them.
    active: Vec<ActiveBlock>,
    tractions: Vec<Tractions4>,
    /// Where the femur was then.
    pose: Pose,
}

impl<'a, B: BroadPhase> FoundationContact<'a, B> {
    /// The contact of bodies, quicker where another left its cache for the insert less worn, under the
    /// same femur.
    pub fn after(cache: ContactCache, law: &'a Foundation, bodies: Bodies<'a>) -> Self {
        let blocks = ShareBlock::of(bodies.insert, bodies.surface);
        let directions = blocks
            .iter()
            .map(|block| Directions4::new(bodies.surface, block));
        Self {
            law,
            bodies,
            directions: directions.collect(),
            search: match cache.into_inner::<Cache<B>>() {
                Some(cache) => cache.search.worn(&cache.blocks, &blocks),
                None => B::new(&blocks),
            },
            cached: vec![CachedSample::nothing(); blocks.len()],
            touched_at: vec![0; blocks.len()],
            response: 1,
            blocks,
            candidates: Vec::new(),
            active: Vec::new(),
            tractions: Vec::new(),
            pose: Pose::identity(),
        }
    }

    /// Lists the blocks that may touch.
    ///
    /// They are found first and sampled after: the processor goes through two short loops faster than
    /// through a long one, where every step waits for the one before.
    fn find_candidates(&mut self, pose: &Pose4) {
        self.candidates.clear();
        for &block in self.search.candidates(&self.pose) {
            let centre = &self.blocks[block as usize].centre;
            self.candidates.push((block, pose.to_femur(centre)));
        }
    }

    /// Samples the femur under every candidate, and keeps those that touch.
    ///
    /// Only what touches is remembered, and until it parts: what is remembered then follows from the
    /// motion alone, and not from what the search named.
    fn sample_candidates(&mut self, pose: &Pose4) {
        let reuse_mm = self.law.sample_reuse_mm;
        self.active.clear();
        self.response += 1;
        for &(block, place) in &self.candidates {
            let at = block as usize;
            let shares = &self.blocks[at];
            let touched = self.touched_at[at] + 1 == self.response;
            let reuses = touched && self.cached[at].reaches(&place, reuse_mm);
            let cached = if reuses {
                self.cached[at].extrapolated(place)
            } else {
                CachedSample::at(self.bodies.femur, place, shares.spread_mm2)
            };
            let normal = pose.turn_to_insert(&cached.sample.normal);
            let slopes =
                EdgeSlopes::new([dot(&normal, &shares.edge_a), dot(&normal, &shares.edge_b)]);
            let reach_mm = slopes.reach_mm();
            if (cached.sample.gap_mm - reach_mm).least() > 0.0 {
                self.search.is_apart(block, || {
                    let curvature = self.bodies.femur.curvature_bounds(&place);
                    SeparationBound::new(&cached.sample, reach_mm, shares, curvature)
                });
            } else {
                self.search.touches(block);
                self.touched_at[at] = self.response;
                if !reuses {
                    self.cached[at] = cached;
                }
                self.active.push(ActiveBlock {
                    block,
                    cached,
                    slopes,
                });
            }
        }
    }

    /// Presses all that touch; the wrench on the insert in the femoral frame, and how regions slip.
    fn press(
        &mut self,
        pose: &Pose4,
        twist: &Twist4,
    ) -> (Wrench<body::Insert, body::Femur>, [Vec3; MOST_REGIONS]) {
        self.tractions.clear();
        let mut total = WrenchSum::new();
        let mut slips = RegionSlips::new();
        for active in &self.active {
            let shares = &self.blocks[active.block as usize];
            let pressed = active.press(self.law, shares, pose, twist);
            let force_n = pressed.force_n(&active.cached.sample.normal, self.law.friction);
            total.add(&active.cached.place, &force_n);
            slips.add(&shares.in_region, &pressed);
            self.tractions.push(pressed);
        }
        (total.total(), slips.means())
    }

    /// The nodes in contact at a motion near that of the last response.
    fn touched(&self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        let way = ShortWay::between(&self.pose, motion);
        let mut touched = Vec::with_capacity(LANES * self.active.len());
        for pressed in self.active.iter().zip(&self.tractions) {
            let block = pressed.0.block as usize;
            let place = (&self.blocks[block], &self.directions[block]);
            way.land(self.law, pressed, place, &mut touched);
        }
        touched
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
        let mut sum = TangentSum::new();
        for (active, tractions) in self.active.chunks(2).zip(self.tractions.chunks(2)) {
            let one = (&active[0].cached, &tractions[0]);
            let nothing = (one.0, &Tractions4::none());
            let other = active.get(1).map(|active| (&active.cached, &tractions[1]));
            sum.add(one, other.unwrap_or(nothing), self.law.friction);
        }
        let (by_pose, by_twist) = sum.total();
        let change = FrameChange::to_femur(&self.pose);
        Tangent {
            by_pose: change.derivative_back(&WrenchByTwist::new(by_pose)),
            by_twist: change.derivative_back(&WrenchByTwist::new(by_twist)),
        }
    }
}

impl<B: BroadPhase> ContactModel for FoundationContact<'_, B> {
    fn node_count(&self) -> usize {
        self.bodies.surface.positions.len()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.search.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response<'_> {
        self.pose = motion.pose;
        let change = FrameChange::to_femur(&self.pose);
        let pose = Pose4::new(&self.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        self.find_candidates(&pose);
        self.sample_candidates(&pose);
        let (wrench, mean_slip) = self.press(&pose, &twist);
        Response::new(change.wrench_back(&wrench), mean_slip, self)
    }

    fn land(&mut self, motion: &RelativeMotion) -> Landing {
        let touched = self.touched(motion);
        Landing {
            peak_pressure_mpa: self.peak_search(&motion.pose).highest_mpa(&touched),
            touched,
        }
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        let (blocks, search) = (self.blocks, self.search);
        ContactMemory {
            state: ContactState::default(),
            cache: ContactCache::of(Cache { blocks, search }),
        }
    }
}
