//! The elastic foundation: rigid bodies, and pressure from local overclosure.
//!
//! [`Foundation`] is the law; it makes a `FoundationContact`, which finds the blocks that touch, presses them
//! (`press`, `mean_overclosure`), and adds up what they do, all as in `contact_patch`. Where an
//! increment ends it says what the highest pressure is (`peak`).

mod mean_overclosure;
mod peak;

use std::sync::Arc;

use super::{
    broad_phase::{BroadPhase, BruteForce, Coherent, Search},
    contact_patch::{CachedSample, ContactPatch, Coulomb, NearBlocks, Sliding, Tractions4},
    law::{Bodies, ContactLaw},
    model::{
        ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, Linearization,
        Response, Tangent,
    },
    pressure_law::PressureLaw,
    share_block::ShareBlock,
};
use crate::{
    geometry::Insert,
    number::{F64x4, cross, dot, scale_add, tangential_part, zero_vector},
    spatial::{FrameChange, Pose, Pose4, RelativeMotion, Twist4},
};
pub(crate) use mean_overclosure::EdgeSlopes;
use mean_overclosure::mean_overclosure;
use peak::PeakSearch;

/// The law of an elastic layer on a rigid base under a rigid femur.
///
/// Every node's share of the articulating surface presses with the law's pressure at its mean
/// overclosure, along the femur's normal there, and rubs with regularised Coulomb friction,
///
/// $$ \mathbf f = p A \left( \mathbf n + \mu \frac{\mathbf v_t}{\sqrt{v_t^2 + v_0^2}} \right). $$
///
/// Shares at the edge of contact count with the part of them that presses. Limits: neighbours do not
/// feel each other, so a foundation does not match Hertz, and edge loading is over-estimated
/// (Halloran 2005).
#[derive(Clone, Debug, PartialEq)]
pub struct Foundation {
    /// Pressure from overclosure.
    pub pressure: PressureLaw,
    /// Coulomb's coefficient of friction, mu.
    pub friction: f64,
    /// Speed at which friction has reached 71 % of its full value, v0, mm/s, > 0.
    ///
    /// Smaller is nearer to Coulomb's stick and slip; larger lets parts that should stick creep, and
    /// is easier to solve.
    pub slip_tolerance_mm_per_s: f64,
    /// The search for the nodes that may touch; no result depends on it.
    pub search: Search,
    /// Motion up to which a sample of the femur is extrapolated to second order rather than recomputed,
    /// mm; 0 takes every sample anew.
    ///
    /// This is the one approximation of the search. The second derivatives of a mesh's field vary by
    /// some 0.003/mm from cell to cell: at 0.02 mm the gap errs by less than a millionth of a
    /// millimetre, and the force by a hundred-thousandth.
    pub sample_reuse_mm: f64,
}

impl Foundation {
    /// The motion up to which samples are extrapolated unless said otherwise, mm: most of Newton's
    /// corrections are shorter, so that a mesh's field is mostly sampled once an increment.
    pub const SAMPLE_REUSE_MM: f64 = 0.02;

    /// A foundation that is computed the quick way.
    pub fn new(pressure: PressureLaw, friction: f64, slip_tolerance_mm_per_s: f64) -> Self {
        Self {
            pressure,
            friction,
            slip_tolerance_mm_per_s,
            search: Search::default(),
            sample_reuse_mm: Self::SAMPLE_REUSE_MM,
        }
    }

    /// Its friction.
    pub(crate) fn coulomb(&self) -> Coulomb {
        Coulomb {
            coefficient: self.friction,
            slip_tolerance_mm_per_s: self.slip_tolerance_mm_per_s,
        }
    }
}

impl ContactLaw for Foundation {
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a> {
        let cache = memory.cache;
        match self.search {
            Search::Coherent => Box::new(FoundationContact::<Coherent>::after(cache, self, bodies)),
            Search::BruteForce => {
                Box::new(FoundationContact::<BruteForce>::after(cache, self, bodies))
            }
        }
    }

    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64 {
        self.pressure.pressure(0.0, insert.thickness_mm()[node]).1
    }

    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw> {
        let mut law = self.clone();
        law.slip_tolerance_mm_per_s *= factor;
        Arc::new(law)
    }
}

/// The contact of a femur with an insert as it is now, by a [`Foundation`], with a broad phase `B`.
///
/// Invariant: a response depends on the motion alone, but for samples that are extrapolated
/// ([`Foundation::sample_reuse_mm`]), which change the force by less than a hundred-thousandth. The tangent is the
/// derivative of the response, summed up in single precision: right to six digits.
pub(crate) struct FoundationContact<'a, B> {
    law: &'a Foundation,
    bodies: Bodies<'a>,
    nearby: NearBlocks<'a, B>,
    /// The blocks that touched at the last response.
    patch: ContactPatch,
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
            ShareBlock::from_shares(bodies.insert, bodies.surface),
            law.sample_reuse_mm,
        );
        let patch = ContactPatch::new(bodies.surface, &nearby.blocks, law.coulomb());
        Self {
            law,
            bodies,
            nearby,
            patch,
            slopes: Vec::new(),
        }
    }

    /// Finds the blocks that touch: those with a share of which a corner is overclosed.
    fn find_touching(&mut self, pose: &Pose, pose4: &Pose4) {
        let Self {
            nearby,
            patch,
            slopes,
            ..
        } = self;
        patch.near.clear();
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
                patch.near.push(near);
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
        self.patch.tangent()
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
        self.patch.pose = motion.pose;
        let change = FrameChange::to_femur(&motion.pose);
        let pose = Pose4::new(&motion.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        self.find_touching(&motion.pose, &pose);
        let (law, slopes) = (self.law, &self.slopes);
        let (wrench, mean_slip) = self
            .patch
            .press(&self.nearby.blocks, |place, near, shares| {
                law.press(&near.cached, &slopes[place], shares, &pose, &twist)
            });
        Response::new(change.wrench_back(&wrench), mean_slip, self)
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        let touched = self.patch.touched(&self.nearby.blocks, motion);
        ContactResult {
            peak_pressure_mpa: self.peak_search(&motion.pose).highest_mpa(&touched),
            touched,
        }
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        ContactMemory {
            state: ContactState::default(),
            cache: ContactCache::new(self.nearby.into_cache()),
        }
    }
}

impl Foundation {
    /// Pressure and rubbing on the shares.
    ///
    /// With n the femur's normal, K its curvature, G the gradient of the gap, e_k the share's edges and W
    /// the mean overclosure of the share, a motion a and a turn w of the femur change the middle's
    /// overclosure by G . a, the normal by w x n - K a, and each edge slope n . e_k with the normal.
    #[inline(always)]
    pub(crate) fn press(
        &self,
        cached: &CachedSample,
        slopes: &EdgeSlopes<F64x4>,
        shares: &ShareBlock,
        pose: &Pose4,
        twist: &Twist4,
    ) -> Tractions4 {
        let CachedSample { place, sample } = cached;
        let mean = mean_overclosure(-sample.gap_mm, slopes);
        let (pressure_mpa, slope) = self.pressure.pressures(mean.mm, shares.per_thickness);
        let stiffness = slope * shares.area_mm2;
        let mut load_by_motion = sample.gap_gradient * (mean.by_middle * stiffness);
        let mut load_by_turn = zero_vector();
        if let Some(by_slope) = mean.by_slope {
            let (by_a, by_b) = (by_slope[0] * stiffness, by_slope[1] * stiffness);
            let by_normal = scale_add(&shares.edge_a, by_a, &(shares.edge_b * by_b));
            let by_normal = pose.turn_to_femur(&by_normal);
            let along_surface = tangential_part(&by_normal, &sample.normal);
            load_by_motion -= sample.curvature.times(&along_surface);
            load_by_turn = cross(&sample.normal, &by_normal);
        }
        Tractions4 {
            pressure_mpa,
            area_mm2: shares.area_mm2,
            covered_mm2: mean.by_middle * shares.area_mm2,
            load_by_motion,
            load_by_turn,
            sliding: Sliding::new(
                &twist.velocity(place),
                &sample.normal,
                self.slip_tolerance_mm_per_s,
            ),
        }
    }
}
