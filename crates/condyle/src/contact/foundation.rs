//! The elastic foundation: rigid bodies, and pressure from local overclosure.

use super::{
    ContactModel, Pose, PressureLaw, RelativeMotion, Tangent, TouchedNode, Vec6,
    motion::{Pose4, Twist4, small_motion, twist_to_femur},
    nearness::Nearness,
    partial::{Rises, mean_overclosure},
    seen::Seen,
    shares::Shares4,
    traction::{Sliding, TangentSum, Tractions4, WrenchSum},
};
use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, FemoralSurface, Insert, SurfaceSample},
    number::{LANES, Lanes, Number},
    products::{cross, dot, scaled_plus, without_part_along},
};

/// How the foundation presses and rubs.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundationSettings {
    /// Pressure from overclosure.
    pub law: PressureLaw,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
    /// Speed at which friction has reached 71 % of its full value, mm/s, > 0.
    ///
    /// Friction is mu p v/sqrt(v^2 + v0^2) with this v0. Smaller is nearer to Coulomb's stick and
    /// slip; larger lets parts that should stick creep, and is easier to solve.
    pub slip_tolerance_mm_per_s: f64,
}

/// Contact of a rigid femur with an elastic layer on a rigid base.
///
/// Every node's share of the articulating surface presses with the law's pressure at its mean
/// overclosure, along the femur's normal there. Shares at the edge of contact count with the part
/// of them that presses. Limits: neighbours do not feel each other, so a foundation does not match
/// Hertz, and edge loading is over-estimated (Halloran 2005).
pub struct Foundation<'a> {
    settings: &'a FoundationSettings,
    femur: &'a FemoralSurface,
    surface: ArticulatingSurface,
    /// The surface's own directions at every node.
    directions: Vec<[Vec3; 2]>,
    shares: Vec<Shares4>,
    /// What every four of them saw of the femur.
    seen: Vec<Seen>,
    nearness: Nearness,
    /// What presses at the last response.
    tractions: Vec<Tractions4>,
    /// Where the femur was then.
    pose: Pose,
}

impl<'a> Foundation<'a> {
    /// The foundation of an insert as it is now, under a femur.
    pub fn new(
        settings: &'a FoundationSettings,
        femur: &'a FemoralSurface,
        insert: &Insert,
    ) -> Self {
        let surface = insert.surface();
        let shares = Shares4::of(&surface, insert.thickness_mm());
        Self {
            settings,
            femur,
            directions: (0..surface.positions.len())
                .map(|node| surface.directions(node))
                .collect(),
            nearness: Nearness::new(&shares),
            seen: vec![Seen::nothing(); shares.len()],
            shares,
            surface,
            tractions: Vec::new(),
            pose: Pose::identity(),
        }
    }

    /// The articulating surface that it presses on.
    pub fn surface(&self) -> &ArticulatingSurface {
        &self.surface
    }

    /// The articulating surface, when the contact is no longer needed.
    pub fn into_surface(self) -> ArticulatingSurface {
        self.surface
    }

    /// Goes over all shares that may touch at a motion; see [`ContactModel::respond`].
    #[inline(always)]
    fn go_over_shares(&mut self, motion: &RelativeMotion) -> Vec6 {
        self.pose = motion.pose;
        let to_femur = twist_to_femur(&self.pose);
        let pose = Pose4::new(&self.pose);
        let twist = Twist4::new(&(to_femur * motion.twist));
        self.nearness.travel(&self.pose);
        self.tractions.clear();
        let mut total = WrenchSum::new();
        for four in 0..self.shares.len() {
            if !self.nearness.is_due(four) {
                continue;
            }
            let shares = &self.shares[four];
            let place = pose.to_femur(&shares.centre);
            if self.nearness.is_still_apart(four, shares, &place) {
                continue;
            }
            let sample = self.seen[four].look(self.femur, &place, shares.spread_mm2);
            let rises = rises(shares, &pose.turn_to_insert(&sample.normal));
            if (sample.gap_mm - rises.reach_mm()).least() > 0.0 {
                let around = self.femur.surroundings(&place);
                let reach_mm = rises.reach_mm();
                self.nearness
                    .is_apart(four, shares, place, &sample, reach_mm, around);
                continue;
            }
            self.nearness.touches(four);
            let pressed = press(self.settings, shares, place, &sample, &rises, &pose, &twist);
            total.add(&pressed.place, &pressed.force_n(self.settings.friction));
            self.tractions.push(pressed);
        }
        to_femur.tr_mul(&total.total())
    }
}

/// Rises of the overclosure along both edges of four shares, under a normal in their frame.
#[inline(always)]
fn rises(shares: &Shares4, normal: &Vector<Lanes>) -> Rises<Lanes> {
    Rises::new([dot(normal, &shares.edge_a), dot(normal, &shares.edge_b)])
}

/// Pressure and rubbing on four shares.
///
/// With n the femur's normal, K its curvature, e_k the share's edges and W the mean overclosure of
/// the share, a motion a and a turn w of the femur change the middle's overclosure by G . a, the
/// normal by w x n - K a, and each rise n . e_k with the normal.
#[inline(always)]
fn press(
    settings: &FoundationSettings,
    shares: &Shares4,
    place: Vector<Lanes>,
    sample: &SurfaceSample<Lanes>,
    rises: &Rises<Lanes>,
    pose: &Pose4,
    twist: &Twist4,
) -> Tractions4 {
    let mean = mean_overclosure(-sample.gap_mm, rises);
    let (pressure_mpa, slope) = settings.law.pressures(mean.mm, shares.per_thickness);
    let stiffness = slope * shares.area_mm2;
    let mut load_by_motion = sample.gap_gradient * (mean.by_middle * stiffness);
    let mut load_by_turn = Vector::repeat(Lanes::splat(0.0));
    if let Some(by_rise) = mean.by_rise {
        let [by_a, by_b] = by_rise.map(|by_rise| by_rise * stiffness);
        let by_normal = scaled_plus(&shares.edge_a, by_a, &(shares.edge_b * by_b));
        let by_normal = pose.turn_to_femur(&by_normal);
        let along_surface = without_part_along(&by_normal, &sample.normal);
        load_by_motion -= sample.curvature.times(&along_surface);
        load_by_turn = cross(&sample.normal, &by_normal);
    }
    Tractions4 {
        nodes: shares.nodes,
        place,
        normal: sample.normal,
        curvature: sample.curvature,
        pressure_mpa,
        area_mm2: shares.area_mm2,
        covered_mm2: mean.by_middle * shares.area_mm2,
        load_by_motion,
        load_by_turn,
        sliding: Sliding::new(
            &twist.velocity(&place),
            &sample.normal,
            settings.slip_tolerance_mm_per_s,
        ),
    }
}

impl ContactModel for Foundation<'_> {
    fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
        self.go_over_shares(motion)
    }

    fn tangent(&self) -> Tangent {
        let mut sum = TangentSum::new();
        for tractions in &self.tractions {
            sum.add(tractions, self.settings.friction);
        }
        let (by_pose, by_twist) = sum.total();
        let to_femur = twist_to_femur(&self.pose);
        Tangent {
            by_pose: to_femur.tr_mul(&by_pose) * to_femur,
            by_twist: to_femur.tr_mul(&by_twist) * to_femur,
        }
    }

    fn node_count(&self) -> usize {
        self.surface.positions.len()
    }

    fn touched(&mut self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        let to_femur = twist_to_femur(&self.pose);
        let moved = Twist4::new(&(to_femur * small_motion(&self.pose, &motion.pose)));
        let twist = Twist4::new(&(to_femur * motion.twist));
        let mut touched = Vec::with_capacity(LANES * self.tractions.len());
        for tractions in &self.tractions {
            let tolerance = self.settings.slip_tolerance_mm_per_s;
            self.touch(&tractions.moved(&moved, &twist, tolerance), &mut touched);
        }
        touched
    }
}

impl Foundation<'_> {
    /// Adds those of four shares that press.
    fn touch(&self, tractions: &Tractions4, touched: &mut Vec<TouchedNode>) {
        let turn = Pose4::new(&self.pose);
        let force_n = turn.turn_to_insert(&tractions.force_n(self.settings.friction));
        let sliding = turn.turn_to_insert(&tractions.sliding.velocity_mm_per_s);
        for (lane, &node) in tractions.nodes.iter().enumerate() {
            let pressure_mpa = tractions.pressure_mpa.lane(lane);
            if pressure_mpa * tractions.area_mm2.lane(lane) > 0.0 {
                let at = |vector: &Vector<Lanes>| vector.map(|lanes| lanes.lane(lane));
                let along = |direction: &Vec3| at(&sliding).dot(direction);
                touched.push(TouchedNode {
                    node,
                    is_medial: self.surface.positions[node as usize].z < 0.0,
                    pressure_mpa,
                    covered_mm2: tractions.covered_mm2.lane(lane),
                    force_n: at(&force_n),
                    sliding_mm_per_s: self.directions[node as usize].each_ref().map(along),
                });
            }
        }
    }
}
