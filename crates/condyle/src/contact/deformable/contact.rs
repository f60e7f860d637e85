//! The contact of a rigid femur with a deformable insert.

use std::sync::Arc;

use super::{
    backside::{BACKSIDE_CYCLE_FIELD, BACKSIDE_FIELD, RestingInsert},
    cholesky::Eight,
    complementarity::{Candidate, Pressing},
    compliance::Compliance,
    edge_and_peak::{EdgeOfContact, PeakSearch, squares, squares_everywhere},
    friction::{ElasticFriction, FRICTION_FIELD, Pressed},
    plastic::{FOUND_MM, NodeLoad, PLASTIC_FIELD, PlasticInsert},
};
use crate::{
    Vector,
    contact::{
        broad_phase::BroadPhase,
        contact_patch::{Coulomb, NearBlock, NearBlocks, PressedBlocks, Sliding, Tractions4},
        law::Bodies,
        model::{
            ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, Flattened,
            Linearization, NotBorne, Response, Settled, Tangent, Tipped,
        },
        share_block::ShareBlock,
    },
    number::{F64x4, LANES, Number, cross, dot, vector_from_lanes},
    spatial::{
        FrameChange, Pose, Pose4, RelativeMotion, Twist, Twist4, Vec6, WrenchByTwist, body::Femur,
    },
};

/// A node may touch where the bodies at rest are nearer than this, mm: beside a contact a thin layer bulges,
/// by a few hundredths of what it gives way.
const MAX_BULGE_MM: f64 = 0.1;

/// How a deformable contact is computed beside the compliance.
#[derive(Clone, Copy)]
pub(crate) struct FrictionSettings {
    pub friction: Coulomb,
    /// Motion up to which a sample of the femur is extrapolated, mm.
    pub sample_reuse_mm: f64,
}

/// The contact of a femur with an elastic insert as it is now, with a broad phase `B`.
///
/// What holds: a response depends on the motion alone, but for samples that are extrapolated and for what
/// the complementarity is satisfied to. The tangent is the derivative of the response where no node begins or
/// ceases to press, right to six digits.
pub(crate) struct DeformableContact<'a, B> {
    bodies: Bodies<'a>,
    rubbing: FrictionSettings,
    nearby: NearBlocks<'a, B>,
    pressed: PressedBlocks,
    compliance: Arc<Compliance>,
    pressing: Pressing,
    /// The blocks near the femur, the nodes that may touch, and where each of these is: number among the
    /// blocks, and lane.
    near: Vec<NearBlock>,
    candidates: Vec<Candidate>,
    lanes: Vec<(usize, usize)>,
    /// Of every block the inward normals of its nodes; of those near the femur how gaps change along them.
    inward: Vec<Vector<F64x4>>,
    along: Vec<AlongNormal>,
    /// What the contact after this one is to know.
    state: ContactState,
    /// How the insert yields, if it does, and the loads of the last response.
    plastic: Option<PlasticInsert>,
    node_loads: Vec<NodeLoad>,
    /// Friction where the surface gives way along itself; else it is that of `rubbing`.
    friction: Option<ElasticFriction<'a>>,
    /// How the insert rests on its tray, if it is not bonded to it.
    resting: Option<RestingInsert>,
}

/// Loads of a block of shares, and their derivatives by six motions.
#[derive(Clone, Copy)]
struct Loads4 {
    load_n: [f64; LANES],
    by_motion: [[f64; LANES]; 6],
}

impl Loads4 {
    const NONE: Self = Self {
        load_n: [0.0; LANES],
        by_motion: [[0.0; LANES]; 6],
    };

    fn is_none(&self) -> bool {
        self.load_n == [0.0; LANES]
    }

    fn tractions(
        &self,
        near: &NearBlock,
        along: &AlongNormal,
        area_mm2: F64x4,
        twist: &Twist4,
        friction: Coulomb,
    ) -> Tractions4 {
        let place = &near.cached.place;
        let by_motion = self.by_motion.map(F64x4::new);
        let (force_n, by_motion) = along.forces_n(F64x4::new(self.load_n), &by_motion);
        let [ax, ay, az, x, y, z] = by_motion;
        let load_by_motion = Vector::new(x, y, z);
        let area = Number::max(area_mm2, F64x4::splat(f64::MIN_POSITIVE));
        Tractions4 {
            pressure_mpa: force_n / area,
            area_mm2,
            covered_mm2: area_mm2,
            // What a turn adds beyond that of its motion at the share: the whole load moves.
            load_by_turn: Vector::new(ax, ay, az) - cross(place, &load_by_motion),
            load_by_motion,
            sliding: Sliding::new(
                &twist.velocity(place),
                &near.cached.sample.normal,
                friction.slip_tolerance_mm_per_s,
            ),
        }
    }
}

impl<'a, B: BroadPhase> DeformableContact<'a, B> {
    /// The contact of bodies, of which the insert gives way as `compliance` says; quicker where another left
    /// its cache. The state of `memory` is handed on.
    pub fn after(
        memory: ContactMemory,
        bodies: Bodies<'a>,
        rubbing: FrictionSettings,
        compliance: Arc<Compliance>,
    ) -> Self {
        let nearby = NearBlocks::after(
            memory.cache.into_inner(),
            bodies.femur,
            ShareBlock::of_nodes(bodies.insert, bodies.surface),
            rubbing.sample_reuse_mm,
        );
        let inward = |block: &ShareBlock| {
            -vector_from_lanes(|lane| &bodies.surface.normals[block.nodes[lane] as usize])
        };
        Self {
            pressed: PressedBlocks::none(bodies.surface, &nearby.blocks, rubbing.friction),
            pressing: Pressing::nothing(compliance.node_count()),
            compliance,
            near: Vec::new(),
            candidates: Vec::new(),
            lanes: Vec::new(),
            inward: nearby.blocks.iter().map(inward).collect(),
            along: Vec::new(),
            state: memory.state,
            plastic: None,
            node_loads: Vec::new(),
            friction: None,
            resting: None,
            bodies,
            rubbing,
            nearby,
        }
    }

    /// The same of an insert that yields.
    pub fn yielding(mut self, plastic: Option<PlasticInsert>) -> Self {
        self.plastic = plastic;
        self
    }

    /// The same of an insert that gives way along its surface; `rubbing` is then to be without friction.
    pub fn sticking(mut self, friction: Option<ElasticFriction<'a>>) -> Self {
        self.friction = friction;
        self
    }

    /// The same of an insert that rests on its tray.
    pub fn resting(mut self, resting: Option<RestingInsert>) -> Self {
        self.resting = resting;
        self
    }

    /// How the insert flows under the loads of the last response; how far that moves the surface, mm.
    fn flow(&mut self) -> Result<f64, Flattened> {
        let Some(plastic) = &mut self.plastic else {
            return Ok(0.0);
        };
        let shares = &self.bodies.surface.shares;
        let pressures = self.node_loads.iter();
        let peak_mpa = pressures
            .map(|&(node, load_n)| load_n / shares[node as usize].area_mm2)
            .fold(0.0, f64::max);
        let near = self.candidates.iter().map(|candidate| candidate.node);
        let around = self.bodies.insert.faces_around();
        plastic.flow(&self.node_loads, peak_mpa, near, around)
    }

    /// How the backside comes to rest under them; how far that moves the surface, mm.
    fn rest(&mut self) -> Result<f64, Tipped> {
        let near = self.candidates.iter().map(|candidate| candidate.node);
        let resting = self.resting.as_mut();
        resting.map_or(Ok(0.0), |resting| resting.rest(&self.node_loads, near))
    }

    /// The nodes that press, their loads taken along with a short motion of the femur since the last response.
    fn pressed_nodes(&self, moved: &Twist<Femur, Femur>) -> Vec<Pressed> {
        let mut pressed_nodes = Vec::new();
        for (near, tractions) in self.pressed.loaded() {
            let shares = &self.nearby.blocks[near.block as usize];
            let force_n = tractions.pressure_mpa * tractions.area_mm2;
            let shift = &tractions.load_by_motion;
            let turn = cross(&near.cached.place, shift) + tractions.load_by_turn;
            let by = [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
            for (lane, &node) in shares.nodes.iter().enumerate() {
                let own_n = force_n.lane(lane);
                if own_n * shares.area_mm2.lane(lane) > 0.0 {
                    let by_motion = Vec6::from_fn(|motion, _| by[motion].lane(lane));
                    pressed_nodes.push(Pressed {
                        node,
                        force_n: (own_n + by_motion.dot(&moved.numbers())).max(0.0),
                        by_motion,
                    });
                }
            }
        }
        pressed_nodes
    }

    /// Lists the nodes that may touch.
    fn find_candidates(&mut self, pose: &Pose, pose4: &Pose4) {
        // Where the backside lifts, the surface comes nearer by as much.
        let lift_mm = self.resting.as_ref().map_or(0.0, RestingInsert::lift_mm);
        let most_mm = MAX_BULGE_MM + lift_mm;
        let (near, most) = (&mut self.near, F64x4::splat(most_mm));
        let prepared_mm2 = self.bodies.femur.prepared_spread_mm2();
        near.clear();
        self.nearby
            .find(pose, pose4, |_, _| (most, ()), |block, ()| near.push(block));
        self.candidates.clear();
        self.lanes.clear();
        self.along.clear();
        for (number, near) in self.near.iter().enumerate() {
            let shares = &self.nearby.blocks[near.block as usize];
            let gap_mm = near
                .cached
                .sample
                .gap_at_point_mm(F64x4::splat(prepared_mm2));
            let inward = pose4.turn_to_femur(&self.inward[near.block as usize]);
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
        self.take_what_gives_way();
    }

    /// Takes from the overclosures what the surface gives way by beside what the loads of this response do.
    fn take_what_gives_way(&mut self) {
        let mut take = |set_mm: &mut dyn FnMut(u32) -> f64| {
            for candidate in &mut self.candidates {
                candidate.overclosure_mm[0] -= F64x4::new([set_mm(candidate.node), 0.0, 0.0, 0.0]);
            }
        };
        if let Some(plastic) = &self.plastic {
            take(&mut |node| plastic.set_mm(node));
        }
        if let Some(resting) = &mut self.resting {
            take(&mut |node| resting.set_mm(node));
        }
    }

    /// Finds the loads of all that touch, and keeps those blocks.
    fn find_loads(&mut self) -> Vec<Loads4> {
        let mut loads = vec![Loads4::NONE; self.near.len()];
        let candidates = self.candidates.iter();
        let compliance = self
            .compliance
            .near(candidates.map(|candidate| candidate.node));
        self.node_loads.clear();
        for (place, load) in self.pressing.solve(&self.candidates, &compliance) {
            let (number, lane) = self.lanes[place];
            let node_load = (self.candidates[place].node, load[0].lane(0).max(0.0));
            self.node_loads.push(node_load);
            let block = &mut loads[number];
            block.load_n[lane] = load[0].lane(0).max(0.0);
            for (motion, by) in block.by_motion.iter_mut().enumerate() {
                let at = motion + 1;
                by[lane] = load[at / LANES].lane(at % LANES);
            }
        }
        let mut pressing = loads.iter().map(|loads| !loads.is_none());
        self.along.retain(|_| pressing.next().unwrap_or(false));
        let pressing = self.near.drain(..).zip(&loads);
        let pressing = pressing.filter(|(_, loads)| !loads.is_none());
        self.pressed.near.clear();
        self.pressed.near.extend(pressing.map(|(near, _)| near));
        loads.retain(|loads| !loads.is_none());
        loads
    }
}

impl<B: BroadPhase> Linearization for DeformableContact<'_, B> {
    fn tangent(&self) -> Tangent {
        let mut tangent = self.pressed.tangent();
        if let Some(friction) = &self.friction {
            let change = FrameChange::to_femur(&self.pressed.pose);
            let by_pose = change.derivative_back(&WrenchByTwist::new(friction.tangent()));
            tangent.by_pose.matrix += by_pose.matrix;
        }
        tangent
    }
}

impl<B: BroadPhase> ContactModel for DeformableContact<'_, B> {
    fn node_count(&self) -> usize {
        self.bodies.surface.positions.len()
    }

    fn begin_cycle(&mut self) {
        if let Some(plastic) = &mut self.plastic {
            plastic.cycle.begin();
        }
        if let Some(friction) = &mut self.friction {
            friction.begin_cycle();
        }
        if let Some(resting) = &mut self.resting {
            resting.begin_cycle();
        }
    }

    fn begin_increment(&mut self, increment: usize) {
        self.nearby.begin_increment(increment);
        if let Some(plastic) = &mut self.plastic {
            plastic.cycle.begin_increment(increment);
        }
        if let Some(friction) = &mut self.friction {
            friction.begin_increment(increment);
        }
        if let Some(resting) = &mut self.resting {
            resting.begin_increment(increment);
        }
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response<'_> {
        self.pressed.pose = motion.pose;
        let change = FrameChange::to_femur(&motion.pose);
        let pose = Pose4::new(&motion.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        self.find_candidates(&motion.pose, &pose);
        let (loads, friction) = (self.find_loads(), self.rubbing.friction);
        let along = &self.along;
        let (mut wrench, mean_slip) =
            self.pressed
                .press(&self.nearby.blocks, |place, near, shares| {
                    loads[place].tractions(near, &along[place], shares.area_mm2, &twist, friction)
                });
        let rubbed = self
            .friction
            .is_some()
            .then(|| self.pressed_nodes(&Twist::zero()));
        if let Some((friction, pressed)) = self.friction.as_mut().zip(rubbed) {
            wrench = wrench + friction.respond(&motion.pose, pressed);
        }
        Response::new(change.wrench_back(&wrench), mean_slip, self)
    }

    fn settle(&mut self, _motion: &RelativeMotion) -> Result<Settled, NotBorne> {
        let moved_mm = self.flow()?.max(self.rest()?);
        Ok(if moved_mm <= FOUND_MM {
            Settled::Yes
        } else {
            Settled::RespondAgain
        })
    }

    fn accept(&mut self, motion: &RelativeMotion) {
        if let Some(plastic) = &mut self.plastic {
            plastic.accept();
        }
        if let Some(resting) = &mut self.resting {
            resting.accept();
        }
        if self.friction.is_some() {
            let from = &self.pressed.pose;
            let moved = FrameChange::to_femur(from).twist(&Twist::between(from, &motion.pose));
            let pressed = self.pressed_nodes(&moved);
            if let Some(friction) = &mut self.friction {
                friction.accept(&motion.pose, &moved.numbers(), pressed);
            }
        }
    }

    fn reject(&mut self) {
        if let Some(plastic) = &mut self.plastic {
            plastic.reject();
        }
        if let Some(resting) = &mut self.resting {
            resting.reject();
        }
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        let plastic = self.plastic.as_ref();
        let set_mm = plastic.map_or(0.0, |plastic| plastic.cycle.moved_mm());
        let friction = self.friction.as_ref();
        let friction_mm = friction.map_or(0.0, ElasticFriction::moved_in_a_cycle_mm);
        let resting = self.resting.as_ref();
        let backside_mm = resting.map_or(0.0, RestingInsert::moved_in_a_cycle_mm);
        set_mm.max(friction_mm).max(backside_mm)
    }

    fn land(&mut self, motion: &RelativeMotion) -> ContactResult {
        if let Some(plastic) = &mut self.plastic {
            plastic.land();
        }
        if let Some(resting) = &mut self.resting {
            resting.land();
        }
        let mut touched = self.pressed.touched(&self.nearby.blocks, motion);
        if let Some(friction) = &mut self.friction {
            friction.land(&mut touched);
        }
        let (surface, faces) = (self.bodies.surface, self.bodies.insert.faces_around());
        let pressure2 = squares(&touched);
        let edge = EdgeOfContact {
            surface,
            faces,
            pressure2: &squares_everywhere(self.node_count(), &touched),
        };
        for node in &mut touched {
            node.covered_mm2 = edge.part(node.node) * surface.shares[node.node as usize].area_mm2;
        }
        let peak = PeakSearch {
            shares: &surface.shares,
            faces,
            pressure2: &pressure2,
        };
        ContactResult {
            peak_pressure_mpa: peak.highest_mpa(&touched),
            touched,
        }
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        let mut state = self.state;
        let own = [
            PLASTIC_FIELD,
            FRICTION_FIELD,
            BACKSIDE_FIELD,
            BACKSIDE_CYCLE_FIELD,
        ];
        state.fields.retain(|field| !own.contains(&&*field.name));
        let plastic = self.plastic.map(PlasticInsert::into_memory);
        state
            .fields
            .extend(plastic.and_then(|plastic| plastic.field()));
        let friction = self.friction.into_iter();
        state
            .fields
            .extend(friction.flat_map(ElasticFriction::into_fields));
        let resting = self.resting.into_iter();
        state
            .fields
            .extend(resting.flat_map(RestingInsert::into_fields));
        ContactMemory {
            state,
            cache: ContactCache::of(self.nearby.into_cache()),
        }
    }
}

/// Below this part of its size a gap's slope does not count as one along the normal: the femur stands on edge there.
const MIN_SLOPE: f64 = 0.3;

/// How the gaps of a block of nodes change along the insert's normals there.
///
/// A node that gives way by w along its inward normal m opens the gap g of the bodies at rest to g + s w, with
/// s = G . m and G the gradient of the gap. So the bodies touch where the overclosure -g/s is given way by, and a load
/// N along m is the part there of a force N/s along the femur's normal: both do the same work.
pub(crate) struct AlongNormal {
    slope: F64x4,
    /// Derivatives of the slope by a turn and a shift of the femur.
    by_motion: [F64x4; 6],
}

impl AlongNormal {
    /// With the inward normals of the nodes, in the femoral frame.
    pub fn new(near: &NearBlock, inward: &Vector<F64x4>) -> Self {
        let sample = &near.cached.sample;
        let gradient = &sample.gap_gradient;
        let slope = dot(gradient, inward);
        // A motion a + w x p of the femur's material moves the node by its opposite, and turns m by -w.
        let bent = sample.curvature.times(inward);
        let turn = cross(&near.cached.place, &bent) + cross(inward, gradient);
        let is_steep = slope - F64x4::splat(MIN_SLOPE);
        let counted = |by: F64x4| is_steep.below_zero(F64x4::splat(0.0), -by);
        let by_motion = [turn.x, turn.y, turn.z, bent.x, bent.y, bent.z];
        Self {
            slope: Number::max(slope, F64x4::splat(MIN_SLOPE)),
            by_motion: by_motion.map(counted),
        }
    }

    /// Overclosure of every node, and its derivatives by a turn and a shift of the femur: a motion a + w x p of its
    /// material changes the gap by -G . (a + w x p).
    pub fn overclosures_mm(&self, near: &NearBlock, gap_mm: F64x4) -> [Eight; LANES] {
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
        std::array::from_fn(|lane| [first[lane], second[lane]])
    }

    /// Force along the femur's normal that loads along the insert's are part of, and its derivatives by motion.
    pub fn forces_n(&self, load_n: F64x4, by_motion: &[F64x4; 6]) -> (F64x4, [F64x4; 6]) {
        let per_slope = F64x4::splat(1.0) / self.slope;
        let force_n = load_n * per_slope;
        let by = |motion: usize| (by_motion[motion] - force_n * self.by_motion[motion]) * per_slope;
        (force_n, std::array::from_fn(by))
    }
}
