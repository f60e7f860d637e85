//! The states of a deformable insert that depend on the load history: one interface for yield, friction and backside.

use crate::{
    contact::{
        contact_patch::ContactPatch,
        law::Bodies,
        model::{NotBorne, StateField, TouchedNode},
        share_block::ShareBlock,
    },
    number::{F64x4, Number, cross},
    spatial::{
        Mat6, RelativeMotion, Twist, Vec6, Wrench,
        body::{Femur, Insert},
    },
};

use super::complementarity::Candidate;

/// A load on a node of the surface along the inward normal, N.
pub(crate) type NodeLoad = (u32, f64);

/// A change of the surface of less than this counts as settled, mm: some 1e-5 of its deflection under load.
pub(crate) const SETTLED_MM: f64 = 1e-5;

/// A part of the insert's state that depends on the load history: plastic strain, friction that sticks, the position of
/// a backside that rests.
///
/// A history has a committed state and a trial state. An increment is solved with the trial state; [`settle`] updates
/// that under the loads found, until loads and state agree, and [`accept`] commits it. The next contact resumes from
/// [`into_fields`].
///
/// [`settle`]: Self::settle
/// [`accept`]: Self::accept
/// [`into_fields`]: Self::into_fields
pub(crate) trait LoadHistory {
    /// Begins the cycle of the next activity.
    fn begin_cycle(&mut self);

    /// Begins an increment of the cycle.
    fn begin_increment(&mut self, increment: usize);

    /// Subtracts from the overclosures of the candidates the displacement of the surface in the trial state.
    fn displace(&mut self, _candidates: &mut [Candidate]) {}

    /// Returns how much nearer to the femur the trial state can bring the surface, mm.
    fn lift_mm(&self) -> f64 {
        0.0
    }

    /// Returns the wrench on the insert of the loads along its surface about the femur's origin, in the femoral frame.
    fn respond(&mut self, _patch: &LoadedPatch<'_>) -> Option<Wrench<Insert, Femur>> {
        None
    }

    /// Returns the derivative of that wrench by a motion of the femur.
    fn tangent(&self) -> Option<Mat6> {
        None
    }

    /// Updates the trial state under the loads of the last response, and returns how far that moves the surface, mm.
    ///
    /// # Errors
    /// A load that the insert does not bear.
    fn settle(&mut self, _loads: &SurfaceLoads<'_>) -> Result<f64, NotBorne> {
        Ok(0.0)
    }

    /// Commits the trial state at the end of a step, near the last response.
    fn accept(&mut self, motion: &RelativeMotion, patch: &LoadedPatch<'_>);

    /// Drops the trial state.
    fn reject(&mut self) {}

    /// Ends an increment, and adds to the nodes in contact what the history contributes.
    fn evaluate(&mut self, touched: &mut [TouchedNode]);

    /// Returns how far the surface at rest lies from where it lay at the same increment a cycle before, mm, times the
    /// factor by which it is to repeat itself more exactly than a motion.
    fn moved_in_a_cycle_mm(&self) -> f64;

    /// Returns the fields of the contact's state from which the next contact resumes.
    fn into_fields(self: Box<Self>) -> Vec<StateField>;
}

/// The loads of the last response along the inward normals.
pub(crate) struct SurfaceLoads<'l> {
    pub bodies: Bodies<'l>,
    pub loads: &'l [NodeLoad],
    /// The nodes whose displacement is asked for.
    pub candidates: &'l [Candidate],
}

impl SurfaceLoads<'_> {
    /// Returns the highest pressure, MPa.
    pub fn peak_mpa(&self) -> f64 {
        let shares = &self.bodies.surface.shares;
        let pressures = self.loads.iter();
        pressures
            .map(|&(node, load_n)| load_n / shares[node as usize].area_mm2)
            .fold(0.0, f64::max)
    }

    /// The nodes whose displacement is asked for.
    pub fn near(&self) -> impl Iterator<Item = u32> {
        self.candidates.iter().map(|candidate| candidate.node)
    }
}

/// A node in contact.
#[derive(Clone, Copy)]
pub(crate) struct ContactNode {
    pub node: u32,
    /// The force along the femur's normal, N, and its derivatives by a turn and a shift of the femur in its frame.
    pub force_n: f64,
    pub by_motion: Vec6,
}

/// The contact patch of the last response.
pub(crate) struct LoadedPatch<'p> {
    pub patch: &'p ContactPatch,
    pub blocks: &'p [ShareBlock],
}

impl LoadedPatch<'_> {
    /// Returns the nodes in contact, their forces extrapolated over a short motion of the femur since the last response.
    pub fn nodes(&self, moved: &Twist<Femur, Femur>) -> Vec<ContactNode> {
        let mut nodes = Vec::new();
        for (near, tractions) in self.patch.loaded() {
            let shares = &self.blocks[near.block as usize];
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
