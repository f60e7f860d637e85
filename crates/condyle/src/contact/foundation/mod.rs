//! The elastic foundation: rigid bodies, and pressure from local overclosure.
//!
//! [`Foundation`] is the law; it creates a `FoundationContact`. To follow an evaluation, start at `respond` there: it finds
//! the blocks that touch (`contact_patch::NearBlocks`), computes the tractions on each (`tractions`, from the
//! `mean_overclosure` of its shares) and sums these to the wrench (`contact_patch::ContactPatch`). At the end of an
//! increment `peak` finds the highest pressure.

mod mean_overclosure;
mod peak;

use std::sync::Arc;

use super::{
    broad_phase::ShareBlock,
    contact_patch::{CachedSample, ContactPatch, Sliding, Tractions4},
    law::{Bodies, ContactLaw, ContactSettings},
    model::{
        ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, Response, Tangent,
    },
    pressure_law::PressureLaw,
};
use crate::{
    geometry::Insert,
    number::{F64x4, cross, dot, scale_add, tangential_part, zero_vector},
    spatial::{FrameChange, Pose4, RelativeMotion, Twist4},
};
pub(crate) use mean_overclosure::EdgeSlopes;
use mean_overclosure::mean_overclosure;
use peak::PeakSearch;

/// The law of an elastic layer on a rigid base under a rigid counterface.
///
/// Every node's share of the articulating surface is under the law's pressure at its mean overclosure, along the
/// counterface's normal there, and under regularised Coulomb friction,
///
/// $$ \mathbf f = p A \left( \mathbf n + \mu \frac{\mathbf v_t}{\sqrt{v_t^2 + v_0^2}} \right). $$
///
/// A share at the edge of contact counts only with its part in contact. Limits: neighbours do not interact, so a
/// foundation does not match Hertz, and edge loading is over-estimated (Halloran 2005).
#[derive(Clone, Debug, PartialEq)]
pub struct Foundation {
    /// Pressure from overclosure.
    pub pressure: PressureLaw,
    /// Friction and search.
    pub settings: ContactSettings,
}

impl Foundation {
    /// Creates a foundation with the fast search.
    pub fn new(pressure: PressureLaw, friction: f64, slip_tolerance_mm_per_s: f64) -> Self {
        let settings = ContactSettings::new(friction, slip_tolerance_mm_per_s);
        Self { pressure, settings }
    }
}

impl ContactLaw for Foundation {
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a> {
        let blocks = ShareBlock::from_shares(bodies.insert, bodies.surface);
        Box::new(FoundationContact {
            law: self,
            bodies,
            patch: ContactPatch::new(bodies, blocks, self.settings, memory.cache),
            slopes: Vec::new(),
        })
    }

    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64 {
        self.pressure.pressure(0.0, insert.thickness_mm()[node]).1
    }

    fn slip_tolerance_mm_per_s(&self) -> Option<f64> {
        self.settings.slip_tolerance_of_friction()
    }

    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw> {
        let mut law = self.clone();
        law.settings.slip_tolerance_mm_per_s *= factor;
        Arc::new(law)
    }
}

/// The contact of a counterface with an insert as it is now, by a [`Foundation`].
///
/// Invariant: a response depends on the motion alone, except for extrapolated samples
/// ([`ContactSettings::sample_reuse_mm`]), which change the force by less than a hundred-thousandth. The tangent is the
/// derivative of the response, summed in single precision: accurate to six digits.
struct FoundationContact<'a> {
    law: &'a Foundation,
    bodies: Bodies<'a>,
    /// The blocks that touched at the last response.
    patch: ContactPatch<'a>,
    /// The edge slopes of their shares.
    slopes: Vec<EdgeSlopes<F64x4>>,
}

impl ContactModel for FoundationContact<'_> {
    fn node_count(&self) -> usize {
        self.bodies.surface.positions.len()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.patch.nearby.broad_phase.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response {
        self.patch.pose = motion.pose;
        let change = FrameChange::to_counterface(&motion.pose);
        let pose = Pose4::new(&motion.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        let (ContactPatch { nearby, near, .. }, slopes) = (&mut self.patch, &mut self.slopes);
        near.clear();
        slopes.clear();
        // A block touches if a corner of one of its shares is overclosed.
        nearby.find(
            &motion.pose,
            &pose,
            |cached, shares| {
                let normal = pose.turn_to_insert(&cached.sample.normal);
                let edges =
                    EdgeSlopes::new([dot(&normal, &shares.edge_a), dot(&normal, &shares.edge_b)]);
                (edges.reach_mm(), edges)
            },
            |block, edges| {
                near.push(block);
                slopes.push(edges);
            },
        );
        let law = self.law;
        let (wrench, mean_slip) = self.patch.evaluate(|place, near, shares| {
            law.tractions(&near.cached, &slopes[place], shares, &pose, &twist)
        });
        let wrench = change.wrench_back(&wrench);
        Response { wrench, mean_slip }
    }

    fn tangent(&self) -> Tangent {
        self.patch.tangent()
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        let touched = self.patch.touched(motion);
        let peak = PeakSearch {
            law: &self.law.pressure,
            bodies: self.bodies,
            pose: Pose4::new(&motion.pose),
        };
        ContactResult {
            peak_pressure_mpa: peak.highest_mpa(&touched),
            touched,
        }
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        ContactMemory {
            state: ContactState::default(),
            cache: ContactCache::new(self.patch.nearby.into_cache()),
        }
    }
}

impl Foundation {
    /// Returns the tractions on a block of shares.
    ///
    /// With n the counterface's normal, K its curvature, G the gradient of the gap, e_k the share's edges and W
    /// the mean overclosure of the share, a motion a and a turn w of the counterface change the middle's
    /// overclosure by G . a, the normal by w x n - K a, and each edge slope n . e_k with the normal.
    #[inline(always)]
    fn tractions(
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
        // Inside the contact, where the whole share is in contact, the load depends on the middle alone.
        let mut load_by_turn = zero_vector();
        if let Some(by_slope) = mean.by_slope {
            let (by_a, by_b) = (by_slope[0] * stiffness, by_slope[1] * stiffness);
            let by_normal = scale_add(&shares.edge_a, by_a, &(shares.edge_b * by_b));
            let by_normal = pose.turn_to_counterface(&by_normal);
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
                self.settings.slip_tolerance_mm_per_s,
            ),
        }
    }
}
