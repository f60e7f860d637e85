//! The friction history of a deformable insert: a surface that deflects along itself, where each node sticks or slips.
//!
//! To follow an increment, read `respond` (the loads at a trial pose), `tangent`, `accept` (the loads become the start of
//! the next step) and `evaluate` of [`ElasticFriction`]. The solver for the loads is `stick_slip`.

use std::{cell::RefCell, collections::BTreeMap, sync::Arc};

use super::{
    cholesky::{Eight, get, set, zero},
    complementarity::by_panel,
    compliance::{Compliance, NearMatrix, along_surface},
    history::{ByActivity, LoadHistory, field},
    stick_slip::{ByMotion, FrictionNode, Pair, StickSlip},
};
use crate::{
    Mat3, Vec3,
    contact::{
        contact_patch::{ContactNode, ContactPatch},
        model::{ContactState, StateField, TouchedNode},
    },
    geometry::ArticulatingSurface,
    spatial::{FrameChange, Mat6, Pose, RelativeMotion, Twist, Vec6, Wrench, body},
};

/// Coulomb friction with stick and slip on an elastic surface.
///
/// A node under the normal load F carries a load T along the surface, |T| <= mu F. While an increment moves the
/// counterface's material past it by D, the surface moves along itself by the change of C T, with the compliance C along
/// it; D less this motion is the slip. Where there is slip, T has its limit and the direction of the slip. So T
/// depends on the loads at the start of the increment. The loads of an increment are a trial state, committed once a
/// step is accepted.
///
/// Normal and tangential loads are found one after the other: the displacement along the normal by tangential loads, and
/// the reverse, are neglected.
pub(crate) struct ElasticFriction<'a> {
    coefficient: f64,
    compliance: Arc<Compliance>,
    surface: &'a ArticulatingSurface,
    activities: ByActivity<Held>,
    /// The loads at the end of each increment of the cycle, kept until the same increment of the next cycle.
    ends: BTreeMap<usize, LoadsAlong>,
    /// The state at the start of the increment, and the displacements of some nodes by its loads, mm, by unit load;
    /// NaN where not computed yet.
    start: Held,
    start_mm: Vec<f64>,
    /// The loads at the end of the increment before.
    last_end: LoadsAlong,
    /// The last response: the counterface's pose, the nodes in contact, and the loads along the surface.
    pose: Pose,
    contact: Vec<ContactNode>,
    loaded_nodes: Vec<u32>,
    loads: StickSlip,
    /// The derivatives of those loads by a motion of the counterface in its frame, once the tangent was requested.
    by_motion: RefCell<Vec<[Eight; 2]>>,
    /// The loads of every node of the surface, and whether it sticks.
    loads_n: Vec<Pair>,
    sticks: Vec<bool>,
    moved_in_a_cycle_mm: f64,
}

impl<'a> ElasticFriction<'a> {
    pub fn new(
        state: &ContactState,
        coefficient: f64,
        surface: &'a ArticulatingSurface,
        compliance: Arc<Compliance>,
    ) -> Self {
        let nodes = surface.positions.len();
        let left = state.named(FRICTION_FIELD);
        let left = left.map(|values| Held::from_values(values).unwrap_or_default());
        let activities = ByActivity::new(left.collect());
        let start = activities.start_of(0);
        let mut friction = Self {
            coefficient,
            activities,
            ends: BTreeMap::new(),
            start: Held::default(),
            start_mm: vec![f64::NAN; compliance.node_count()],
            last_end: LoadsAlong::new(),
            pose: Pose::identity(),
            contact: Vec::new(),
            loaded_nodes: Vec::new(),
            loads: StickSlip::default(),
            by_motion: RefCell::default(),
            loads_n: vec![[0.0; 2]; nodes],
            sticks: vec![false; nodes],
            moved_in_a_cycle_mm: 0.0,
            compliance,
            surface,
        };
        friction.resume(start);
        friction
    }

    /// Resumes from the state in which an activity was left.
    fn resume(&mut self, start: Held) {
        self.start = start;
        self.last_end.clone_from(&self.start.loads);
        // Displacements belong to the loads at the start, which change here.
        self.start_mm.fill(f64::NAN);
        self.loads_n.fill([0.0; 2]);
        for &(node, load_n) in &self.start.loads {
            self.loads_n[node as usize] = load_n;
        }
    }

    /// Solves for the loads along the surface with the counterface at a pose.
    fn solve(&mut self, pose: &Pose, contact: Vec<ContactNode>) {
        self.by_motion.get_mut().clear();
        self.set_contact(pose, contact);
        let compliance = Arc::clone(&self.compliance);
        let compliance = compliance.near(self.asked());
        let nodes = self.friction_nodes(&compliance);
        self.loads.solve(&nodes, &compliance);
        self.loaded_nodes.clear();
        self.loaded_nodes.extend(nodes.iter().map(|node| node.node));
        self.spread();
    }

    fn set_contact(&mut self, pose: &Pose, contact: Vec<ContactNode>) {
        for before in std::mem::replace(&mut self.contact, contact) {
            self.sticks[before.node as usize] = false;
        }
        self.pose = *pose;
    }

    /// Copies the loads found to the nodes of the surface.
    fn spread(&mut self) {
        self.loads_n.fill([0.0; 2]);
        for (place, &node) in self.loaded_nodes.iter().enumerate() {
            self.loads_n[node as usize] = self.loads.load_n(place);
            self.sticks[node as usize] = self.loads.sticks(place);
        }
    }

    /// Returns the loads of the last response, without nodes that carry none.
    fn loads_now(&self) -> LoadsAlong {
        let nodes = self.contact.iter().map(|node| node.node);
        let loads = nodes.map(|node| (node, self.loads_n[node as usize]));
        let mut loads: LoadsAlong = loads.filter(|(_, load_n)| *load_n != [0.0; 2]).collect();
        loads.sort_unstable_by_key(|&(node, _)| node);
        loads
    }

    /// Returns the unit loads for which the compliance is needed.
    fn asked(&self) -> impl Iterator<Item = u32> {
        let contact = self.contact.iter().map(|node| node.node);
        let held = self.start.loads.iter().chain(&self.last_end);
        let held = held.map(|&(node, _)| node);
        contact.chain(held).flat_map(along_surface)
    }

    /// Returns the nodes in contact, each with its limit and the motion of the counterface past it since it carried no load;
    /// none before the first accepted step, since there is no motion yet.
    fn friction_nodes(&mut self, compliance: &NearMatrix) -> Vec<FrictionNode> {
        let Some(start) = self.start.pose else {
            return Vec::new();
        };
        let mut held = None;
        let mut start_mm = |load: u32| {
            let known = &mut self.start_mm[load as usize];
            if known.is_nan() {
                let held = held.get_or_insert_with(|| panels(&self.start.loads, compliance));
                *known = compliance.moved(compliance.row(load), held);
            }
            *known
        };
        let friction_node = |touched: &ContactNode| {
            let node = touched.node as usize;
            let place = &self.surface.positions[node];
            // The material of the counterface that is at the node now, and where it was at the start.
            let moved = place - start.to_insert(&self.pose.to_counterface(place));
            let along = self.surface.directions(node).map(|along| along.dot(&moved));
            let before = along_surface(touched.node).map(&mut start_mm);
            FrictionNode {
                node: touched.node,
                limit_n: self.coefficient * touched.force_n,
                reach_mm: [along[0] + before[0], along[1] + before[1]],
                load_n: self.loads_n[node],
            }
        };
        self.contact.iter().map(friction_node).collect()
    }

    /// Returns the screws of the two directions of a node in the counterface frame, the directions turned there by the transpose
    /// of `rotation`.
    ///
    /// A screw is the wrench of a unit load along its direction; its product with a motion of the counterface is the motion of the
    /// counterface's material along that direction.
    fn screws(&self, node: usize, rotation: &Mat3) -> [Vec6; 2] {
        let place = self.pose.to_counterface(&self.surface.positions[node]);
        self.surface.directions(node).map(|along| {
            let along = rotation.tr_mul(&along);
            let moment = place.cross(&along);
            Vec6::new(moment.x, moment.y, moment.z, along.x, along.y, along.z)
        })
    }
}

impl LoadHistory for ElasticFriction<'_> {
    fn begin_cycle(&mut self) {
        let start = self.activities.begin_cycle(std::mem::take(&mut self.start));
        self.ends.clear();
        self.resume(start);
    }

    fn respond(
        &mut self,
        patch: &ContactPatch<'_>,
    ) -> Option<Wrench<body::Insert, body::Counterface>> {
        let pose = &patch.pose;
        self.solve(pose, patch.nodes(&Twist::zero()));
        let mut total = Wrench::zero();
        for &node in &self.loaded_nodes {
            let screws = self.screws(node as usize, &pose.rotation);
            let [x, y] = self.loads_n[node as usize];
            total = total + Wrench::from_numbers(&(screws[0] * x + screws[1] * y));
        }
        Some(total)
    }

    fn tangent(&self) -> Option<Mat6> {
        let mut tangent = Mat6::zeros();
        let Some(start) = self.start.pose.filter(|_| !self.contact.is_empty()) else {
            return Some(tangent);
        };
        let change = |touched: &ContactNode| {
            let moved = self.screws(touched.node as usize, &start.rotation);
            ByMotion {
                reach_mm: moved.map(|screw| eight(&screw)),
                limit_n: eight(&(touched.by_motion * self.coefficient)),
            }
        };
        let changes: Vec<ByMotion> = self.contact.iter().map(change).collect();
        let compliance = self.compliance.near(self.asked());
        // A motion enters through the screws at the start of the increment, where the motion past the nodes is counted from;
        // the wrench is that of the loads at the present pose.
        let loads = self.loads.by_motion(&changes, &compliance);
        for (touched, loads) in self.contact.iter().zip(&loads) {
            let screws = self.screws(touched.node as usize, &self.pose.rotation);
            for (screw, load) in screws.iter().zip(loads) {
                tangent += screw * six(load).transpose();
            }
        }
        self.by_motion.replace(loads);
        Some(tangent)
    }

    /// The accepted motion differs slightly from that of the last response. The loads follow by their derivatives if
    /// the tangent was requested there; otherwise they are solved again.
    fn accept(&mut self, motion: &RelativeMotion, patch: &ContactPatch<'_>) {
        let (from, pose) = (&patch.pose, &motion.pose);
        let moved = FrameChange::to_counterface(from).twist(&Twist::between(from, pose));
        let contact = patch.nodes(&moved);
        let by_motion = self.by_motion.take();
        if by_motion.is_empty() {
            self.solve(pose, contact);
        } else {
            let changes = by_motion.iter();
            let changes_n: Vec<Pair> = changes
                .map(|loads| [0, 1].map(|k| six(&loads[k]).dot(&moved.numbers())))
                .collect();
            self.set_contact(pose, contact);
            let compliance = Arc::clone(&self.compliance);
            let compliance = compliance.near(self.asked());
            let nodes = self.friction_nodes(&compliance);
            self.loads.extrapolate(&nodes, &changes_n, &compliance);
            self.spread();
        }
        self.start = Held {
            pose: Some(*pose),
            loads: self.loads_now(),
        };
        // The displacements under the new start are known at the loaded nodes; at others they are computed on demand.
        self.start_mm.fill(f64::NAN);
        for (place, node) in self.loaded_nodes.iter().enumerate() {
            let moved_mm = self.loads.moved_mm(place);
            for (load, moved_mm) in along_surface(*node).into_iter().zip(moved_mm) {
                self.start_mm[load as usize] = moved_mm;
            }
        }
    }

    fn evaluate(&mut self, increment: usize, touched: &mut [TouchedNode]) {
        let now = self.loads_now();
        let compliance = Arc::clone(&self.compliance);
        let compliance = compliance.near(self.asked());
        let changes = differences(&now, &self.last_end);
        let change = panels(&changes, &compliance);
        for node in touched {
            let at = node.node as usize;
            let loads = self
                .surface
                .directions(at)
                .into_iter()
                .zip(self.loads_n[at]);
            node.force_n += loads.map(|(along, load_n)| along * load_n).sum::<Vec3>();
            // A sticking node has no slip: no wear follows from its regularised velocity.
            if self.sticks[at] {
                node.sliding_mm_per_s = [0.0; 2];
            } else {
                let rows = along_surface(node.node).map(|load| compliance.row(load));
                node.along_mm = rows.map(|row| compliance.moved(row, &change));
            }
        }
        // A cycle repeats itself once the loads of an increment do; a change of load counts by the deflection that it would
        // cause alone.
        let moved_mm = |&(node, by_n): &(u32, Pair)| {
            let own = along_surface(node).map(|load| compliance.row(load));
            let [x, y] = own.map(|row| compliance.at(row, row));
            (x * by_n[0]).hypot(y * by_n[1])
        };
        let before = self.ends.insert(increment, now.clone());
        self.moved_in_a_cycle_mm = before.map_or(f64::INFINITY, |before| {
            let changes = differences(&now, &before);
            changes.iter().map(moved_mm).fold(0.0, f64::max)
        });
        self.last_end = now;
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        self.moved_in_a_cycle_mm
    }

    fn into_fields(self: Box<Self>) -> Vec<StateField> {
        let left = self.activities.finish(self.start).into_iter();
        left.map(|held| field(FRICTION_FIELD, held.values()))
            .collect()
    }
}

/// Arranges loads along the surface by the panels of the compliance.
fn panels(loads: &LoadsAlong, compliance: &NearMatrix) -> Vec<(usize, Eight)> {
    let numbers = loads.iter().flat_map(|&(node, _)| along_surface(node));
    let loads_n = loads.iter().flat_map(|&(_, load_n)| load_n);
    let (numbers, loads_n): (Vec<u32>, Vec<f64>) = numbers.zip(loads_n).unzip();
    by_panel(&numbers, &loads_n, compliance)
}

fn differences(now: &LoadsAlong, before: &LoadsAlong) -> LoadsAlong {
    let mut changes: BTreeMap<u32, Pair> = now.iter().copied().collect();
    for &(node, [x, y]) in before {
        let change = changes.entry(node).or_default();
        *change = [change[0] - x, change[1] - y];
    }
    changes.into_iter().collect()
}

fn six(numbers: &Eight) -> Vec6 {
    Vec6::from_fn(|motion, _| get(numbers, motion))
}

/// Pads six numbers with zeros.
fn eight(six: &Vec6) -> Eight {
    let mut numbers = zero();
    six.iter()
        .enumerate()
        .for_each(|(side, number)| set(&mut numbers, side, *number));
    numbers
}

/// The fields of the contact's state with what each activity left: the counterface's pose, rotation by columns and then
/// translation in mm, and of every node that carries a load along the surface its number and that load.
const FRICTION_FIELD: &str = "femur_pose_and_loads_along_surface_n";

/// Numbers of a pose in that field.
const OF_POSE: usize = 12;

/// Loads along the surface on some nodes, ascending, N.
type LoadsAlong = Vec<(u32, Pair)>;

/// The state at the start of an increment.
#[derive(Clone, Debug, Default, PartialEq)]
struct Held {
    /// The pose of the counterface; none before the first step.
    pose: Option<Pose>,
    loads: LoadsAlong,
}

impl Held {
    fn from_values(values: &[f64]) -> Option<Self> {
        let (pose, loads) = values.split_at_checked(OF_POSE)?;
        let rotation = Mat3::from_column_slice(&pose[..9]);
        let translation = Vec3::from_column_slice(&pose[9..]);
        let loads = loads.chunks_exact(3);
        Some(Self {
            pose: Some(Pose::new(rotation, translation)),
            loads: loads.map(|of| (of[0] as u32, [of[1], of[2]])).collect(),
        })
    }

    fn values(&self) -> Vec<f64> {
        let Some(pose) = &self.pose else {
            return Vec::new();
        };
        let pose = pose.rotation.iter().chain(&pose.translation).copied();
        let loads = self.loads.iter();
        let loads = loads.flat_map(|&(node, [x, y])| [f64::from(node), x, y]);
        pose.chain(loads).collect()
    }
}
