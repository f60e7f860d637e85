//! The contact of a rigid counterface with a deformable insert: one evaluation for elastic, yielding, sticking and resting inserts.
//!
//! To follow an evaluation, start at `respond` of [`DeformableContact`]: candidates and their gaps along the insert's normals,
//! the loads that keep the bodies just in touch (`complementarity`), and the wrench of these. `settle`, `accept` and
//! `evaluate` pass the loads on to the histories.

use std::{array::from_fn, sync::Arc};

use super::{
    cholesky::{Eight, get},
    complementarity::{Candidate, ContactSet},
    compliance::Compliance,
    edge_and_peak::NodePressures,
    history::{LoadHistory, NodeLoad, SurfaceLoads},
};
use crate::{
    Vector,
    contact::{
        broad_phase::ShareBlock,
        contact_patch::{ContactPatch, NearBlock, Sliding, Tractions4},
        law::{Bodies, ContactSettings},
        model::{
            ContactCache, ContactMemory, ContactModel, ContactResult, NotBorne, Response, Settled,
            StateField, Tangent,
        },
    },
    number::{F64x4, LANES, Number, cross, dot, vector_from_lanes},
    spatial::{FrameChange, Pose, Pose4, RelativeMotion, Twist4, WrenchByTwist},
};

/// A node may touch where the bodies at rest are nearer than this, mm: next to a contact a thin layer bulges by a few
/// hundredths of its deflection.
const MAX_BULGE_MM: f64 = 0.1;

/// The contact of a counterface with an elastic insert as it is now.
///
/// Invariant: a response depends on the motion alone, except for extrapolated samples and the tolerance of the
/// complementarity. The tangent is the derivative of the response as long as no node comes into contact or leaves it,
/// accurate to six digits.
pub(crate) struct DeformableContact<'a> {
    bodies: Bodies<'a>,
    settings: ContactSettings,
    patch: ContactPatch<'a>,
    compliance: Arc<Compliance>,
    contact_set: ContactSet,
    /// The blocks near the counterface, the nodes that may touch, and the place of each of these: number among the blocks, and
    /// lane.
    near: Vec<NearBlock>,
    candidates: Vec<Candidate>,
    lanes: Vec<(usize, usize)>,
    /// The inward normals of the nodes of every block; for blocks near the counterface the change of the gaps along them.
    inward: Vec<Vector<F64x4>>,
    along: Vec<AlongNormal>,
    /// Fields of the state that belong to no history, kept for the next contact.
    fields: Vec<StateField>,
    /// The loads of the last response, and the parts of the state that depend on the load history.
    node_loads: Vec<NodeLoad>,
    histories: Vec<Box<dyn LoadHistory + 'a>>,
    increment: usize,
}

/// The loads on a block of nodes along the inward normals, N, followed by their derivatives by six motions.
type Loads4 = [[f64; LANES]; 7];

impl<'a> DeformableContact<'a> {
    /// Creates the contact of bodies; the cache of another contact makes it faster. Histories
    /// resume from their own part of the state; `memory` holds the other fields, which are passed
    /// on. With a history of friction, the friction of `settings` is zero.
    pub fn new(
        memory: ContactMemory,
        bodies: Bodies<'a>,
        settings: ContactSettings,
        compliance: Arc<Compliance>,
        histories: Vec<Box<dyn LoadHistory + 'a>>,
    ) -> Self {
        let blocks = ShareBlock::from_nodes(bodies.insert, bodies.surface);
        let inward = |block: &ShareBlock| {
            -vector_from_lanes(|lane| &bodies.surface.normals[block.nodes[lane] as usize])
        };
        Self {
            contact_set: ContactSet::new(compliance.node_count()),
            compliance,
            near: Vec::new(),
            candidates: Vec::new(),
            lanes: Vec::new(),
            inward: blocks.iter().map(inward).collect(),
            along: Vec::new(),
            fields: memory.state.fields,
            node_loads: Vec::new(),
            histories,
            increment: 0,
            bodies,
            settings,
            patch: ContactPatch::new(bodies, blocks, settings, memory.cache),
        }
    }

    /// Lists the nodes that may touch.
    fn find_candidates(&mut self, pose: &Pose, pose4: &Pose4) {
        // If the backside lifts, the surface comes nearer by as much.
        let lifts_mm = self.histories.iter().map(|history| history.lift_mm());
        let most_mm = MAX_BULGE_MM + lifts_mm.fold(0.0, f64::max);
        let (near, most) = (&mut self.near, F64x4::splat(most_mm));
        // A mesh's field is smoothed over a share; the gap is needed at the node.
        let prepared_mm2 = F64x4::splat(self.bodies.counterface.prepared_spread_mm2());
        near.clear();
        let nearby = &mut self.patch.nearby;
        nearby.find(pose, pose4, |_, _| (most, ()), |block, ()| near.push(block));
        self.candidates.clear();
        self.lanes.clear();
        self.along.clear();
        for (number, near) in self.near.iter().enumerate() {
            let shares = &nearby.blocks[near.block as usize];
            let gap_mm = near.cached.sample.gap_at_point_mm(prepared_mm2);
            let inward = pose4.turn_to_counterface(&self.inward[near.block as usize]);
            let along = AlongNormal::new(near, &inward);
            let overclosures = along.overclosures_mm(near, gap_mm);
            self.along.push(along);
            for (lane, &node) in shares.nodes.iter().enumerate() {
                let is_near = gap_mm.lane(lane) <= most_mm;
                if is_near && shares.area_mm2.lane(lane) > 0.0 {
                    self.candidates.push(Candidate {
                        node,
                        overclosure_mm: overclosures[lane],
                    });
                    self.lanes.push((number, lane));
                }
            }
        }
        for history in &mut self.histories {
            history.displace(&mut self.candidates);
        }
    }

    /// Finds the loads on the candidates, and keeps the blocks that carry one.
    fn find_loads(&mut self) -> Vec<Loads4> {
        let mut loads = vec![Loads4::default(); self.near.len()];
        let nodes = self.candidates.iter().map(|candidate| candidate.node);
        let compliance = self.compliance.near(nodes);
        self.node_loads.clear();
        for (place, load) in self.contact_set.solve(&self.candidates, &compliance) {
            let (number, lane) = self.lanes[place];
            for (at, numbers) in loads[number].iter_mut().enumerate() {
                numbers[lane] = get(load, at);
            }
            let load_n = &mut loads[number][0][lane];
            // By round-off a load may be slightly tensile.
            *load_n = load_n.max(0.0);
            self.node_loads.push((self.candidates[place].node, *load_n));
        }
        let is_loaded = |loads: &Loads4| loads[0] != [0.0; LANES];
        let mut loaded = loads.iter().map(is_loaded);
        self.along.retain(|_| loaded.next().unwrap_or(false));
        let near = self.near.drain(..).zip(&loads);
        let near = near.filter(|(_, loads)| is_loaded(loads));
        self.patch.near.clear();
        self.patch.near.extend(near.map(|(near, _)| near));
        loads.retain(is_loaded);
        loads
    }
}

impl ContactModel for DeformableContact<'_> {
    fn node_count(&self) -> usize {
        self.bodies.surface.positions.len()
    }

    fn begin_cycle(&mut self) {
        for history in &mut self.histories {
            history.begin_cycle();
        }
    }

    fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
        self.patch.nearby.broad_phase.begin_increment(increment);
        for history in &mut self.histories {
            history.begin_increment(increment);
        }
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response {
        self.patch.pose = motion.pose;
        let change = FrameChange::to_counterface(&motion.pose);
        let pose = Pose4::new(&motion.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        self.find_candidates(&motion.pose, &pose);
        let (loads, settings) = (self.find_loads(), self.settings);
        let along = &self.along;
        let (mut wrench, mean_slip) = self.patch.evaluate(|place, near, shares| {
            along[place].tractions(&loads[place], near, shares.area_mm2, &twist, settings)
        });
        for history in &mut self.histories {
            if let Some(along_surface) = history.respond(&self.patch) {
                wrench = wrench + along_surface;
            }
        }
        let wrench = change.wrench_back(&wrench);
        Response { wrench, mean_slip }
    }

    fn tangent(&self) -> Tangent {
        let mut tangent = self.patch.tangent();
        let histories = self.histories.iter();
        for along_surface in histories.filter_map(|history| history.tangent()) {
            let change = FrameChange::to_counterface(&self.patch.pose);
            let by_pose = change.derivative_back(&WrenchByTwist::new(along_surface));
            tangent.by_pose.matrix += by_pose.matrix;
        }
        tangent
    }

    fn settle(&mut self, _motion: &RelativeMotion) -> Result<Settled, NotBorne> {
        let loads = SurfaceLoads {
            bodies: self.bodies,
            loads: &self.node_loads,
            candidates: &self.candidates,
        };
        // All histories are settled under the same loads; the step is solved again if any of them moves the surface.
        let mut settled = Settled::Yes;
        for history in &mut self.histories {
            if history.settle(&loads)? == Settled::RespondAgain {
                settled = Settled::RespondAgain;
            }
        }
        Ok(settled)
    }

    fn accept(&mut self, motion: &RelativeMotion) {
        for history in &mut self.histories {
            history.accept(motion, &self.patch);
        }
    }

    fn reject(&mut self) {
        for history in &mut self.histories {
            history.reject();
        }
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        let histories = self.histories.iter();
        histories
            .map(|history| history.moved_in_a_cycle_mm())
            .fold(0.0, f64::max)
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        let mut touched = self.patch.touched(motion);
        for history in &mut self.histories {
            history.evaluate(self.increment, &mut touched);
        }
        let pressures = NodePressures::new(self.bodies, &touched);
        for node in &mut touched {
            let share = &self.bodies.surface.shares[node.node as usize];
            node.covered_mm2 = pressures.part(node.node) * share.area_mm2;
        }
        ContactResult {
            peak_pressure_mpa: pressures.highest_mpa(&touched),
            touched,
        }
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        let mut memory = ContactMemory::default();
        memory.state.fields = self.fields;
        let histories = self.histories.into_iter();
        let own = histories.flat_map(LoadHistory::into_fields);
        memory.state.fields.extend(own);
        memory.cache = ContactCache::new(self.patch.nearby.into_cache());
        memory
    }
}

/// Smaller slopes of the gap along the normal are replaced by this one: the counterface stands on edge there, and a division by a
/// slope near zero would exaggerate the gap.
const MIN_SLOPE: f64 = 0.3;

/// The change of the gaps of a block of nodes along the insert's normals.
///
/// A node that deflects by w along its inward normal m opens the gap g of the bodies at rest to g + s w, with
/// s = G . m and G the gradient of the gap. So the bodies touch if the node deflects by the overclosure -g/s, and a load
/// N along m is the component of a force N/s along the counterface's normal: both do the same work.
struct AlongNormal {
    slope: F64x4,
    /// Derivatives of the slope by a turn and a shift of the counterface.
    by_motion: [F64x4; 6],
}

impl AlongNormal {
    /// From the inward normals of the nodes, in the counterface frame.
    fn new(near: &NearBlock, inward: &Vector<F64x4>) -> Self {
        let sample = &near.cached.sample;
        let gradient = &sample.gap_gradient;
        let slope = dot(gradient, inward);
        // A motion a + w x p of the counterface's material moves the node by its opposite, and turns m by -w.
        let bent = sample.curvature.times(inward);
        let turn = cross(&near.cached.place, &bent) + cross(inward, gradient);
        // A slope that is replaced does not depend on the motion.
        let is_steep = slope - F64x4::splat(MIN_SLOPE);
        let counted = |by: F64x4| is_steep.below_zero(F64x4::splat(0.0), -by);
        let by_motion = [turn.x, turn.y, turn.z, bent.x, bent.y, bent.z];
        Self {
            slope: Number::max(slope, F64x4::splat(MIN_SLOPE)),
            by_motion: by_motion.map(counted),
        }
    }

    /// Returns the overclosure of every node, and its derivatives by a turn and a shift of the counterface: a motion a + w x p of
    /// its material changes the gap by -G . (a + w x p).
    fn overclosures_mm(&self, near: &NearBlock, gap_mm: F64x4) -> [Eight; LANES] {
        let gradient = &near.cached.sample.gap_gradient;
        let turn = cross(&near.cached.place, gradient);
        let per_slope = F64x4::splat(1.0) / self.slope;
        let overclosure_mm = -gap_mm * per_slope;
        let [ax, ay, az, x, y, z] = self.by_motion.map(|by| by * overclosure_mm);
        let by = |closing: F64x4, steeper: F64x4| (closing - steeper) * per_slope;
        let first = F64x4::transposed([
            overclosure_mm,
            by(turn.x, ax),
            by(turn.y, ay),
            by(turn.z, az),
        ]);
        let second = F64x4::transposed([
            by(gradient.x, x),
            by(gradient.y, y),
            by(gradient.z, z),
            F64x4::splat(0.0),
        ]);
        from_fn(|lane| [first[lane], second[lane]])
    }

    /// Returns the tractions on a block under loads along the insert's normals.
    fn tractions(
        &self,
        loads: &Loads4,
        near: &NearBlock,
        area_mm2: F64x4,
        twist: &Twist4,
        settings: ContactSettings,
    ) -> Tractions4 {
        let place = &near.cached.place;
        let [load_n, by_motion @ ..] = loads.map(F64x4::new);
        let per_slope = F64x4::splat(1.0) / self.slope;
        let force_n = load_n * per_slope;
        let by = |motion: usize| (by_motion[motion] - force_n * self.by_motion[motion]) * per_slope;
        let [ax, ay, az, x, y, z] = from_fn(by);
        let load_by_motion = Vector::new(x, y, z);
        // Unused lanes have no area.
        let area = Number::max(area_mm2, F64x4::splat(f64::MIN_POSITIVE));
        Tractions4 {
            pressure_mpa: force_n / area,
            area_mm2,
            covered_mm2: area_mm2,
            // The derivative by a turn about the origin, minus that by the motion of the material which the turn causes at
            // the share.
            load_by_turn: Vector::new(ax, ay, az) - cross(place, &load_by_motion),
            load_by_motion,
            sliding: Sliding::new(
                &twist.velocity(place),
                &near.cached.sample.normal,
                settings.slip_tolerance_mm_per_s,
            ),
        }
    }
}
