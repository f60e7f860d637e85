//! The elastic foundation: rigid bodies, and pressure from local overclosure.

use super::{
    ContactModel, Mat6, Pose, PressureLaw, RelativeMotion, Tangent, TouchedNode, Vec6,
    candidates::Candidates,
    motion::twist_to_femur,
    partial::mean_overclosure,
    traction::{Rubbing, Traction, split_velocity, wrench},
};
use crate::{
    Vec3,
    geometry::{ArticulatingSurface, FemoralSurface, Insert},
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
    thickness_mm: Vec<f64>,
    candidates: Candidates,
    /// What presses at the last response.
    tractions: Vec<Traction>,
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
        Self {
            directions: (0..surface.positions.len())
                .map(|node| surface.directions(node))
                .collect(),
            settings,
            femur,
            candidates: Candidates::new(&surface),
            thickness_mm: insert.thickness_mm().to_vec(),
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

    /// Pressure and rubbing on one share, if any of it presses.
    ///
    /// With n the femur's normal, K its curvature, e_k the share's edges and W the mean
    /// overclosure of the share, a motion a and a turn w of the femur change the middle's
    /// overclosure by G . a, the normal by w x n - K a, and each rise n . e_k with the normal.
    #[inline]
    fn press(&self, node: u32, pose: &Pose, angular: &Vec3, linear: &Vec3) -> Option<Traction> {
        let share = &self.surface.shares[node as usize];
        let place = pose.to_femur(&share.centre);
        let sample = self.femur.sample(&place, share.spread_mm2);
        let normal_in_insert = pose.rotation * sample.normal;
        let rise = [
            normal_in_insert.dot(&share.edge_a),
            normal_in_insert.dot(&share.edge_b),
        ];
        let mean = mean_overclosure(-sample.gap_mm, rise)?;
        let (pressure_mpa, slope) = self
            .settings
            .law
            .pressure(mean.mm, self.thickness_mm[node as usize]);
        let stiffness = slope * share.area_mm2;
        let mut load_by_motion = sample.gap_gradient * (mean.by_middle * stiffness);
        let mut load_by_turn = Vec3::zeros();
        if mean.by_middle < 1.0 {
            let by_normal =
                (share.edge_a * mean.by_rise[0] + share.edge_b * mean.by_rise[1]) * stiffness;
            let by_normal = pose.rotation.tr_mul(&by_normal);
            let along_surface = by_normal - sample.normal * sample.normal.dot(&by_normal);
            load_by_motion -= sample.curvature * along_surface;
            load_by_turn = sample.normal.cross(&by_normal);
        }
        let velocity = linear + angular.cross(&place);
        let (along, sliding_mm_per_s, closing_mm_per_s) = split_velocity(&velocity, &sample.normal);
        Some(Traction {
            node,
            place,
            normal: sample.normal,
            curvature: sample.curvature,
            pressure_mpa,
            load_n: pressure_mpa * share.area_mm2,
            covered_mm2: mean.by_middle * share.area_mm2,
            load_by_motion,
            load_by_turn,
            along,
            sliding_mm_per_s,
            closing_mm_per_s,
        })
    }

    fn rubbing(&self) -> Rubbing {
        Rubbing {
            friction: self.settings.friction,
            slip_tolerance_mm_per_s: self.settings.slip_tolerance_mm_per_s,
        }
    }
}

impl ContactModel for Foundation<'_> {
    fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
        self.pose = motion.pose;
        let to_femur = twist_to_femur(&self.pose);
        let twist = to_femur * motion.twist;
        let (angular, linear) = (
            twist.fixed_rows::<3>(0).into(),
            twist.fixed_rows::<3>(3).into(),
        );
        self.candidates
            .update(&self.pose, self.femur, &self.surface.shares);
        let mut tractions = std::mem::take(&mut self.tractions);
        tractions.clear();
        let gap_mm = |node: u32| {
            self.femur.gap_mm(
                &self
                    .pose
                    .to_femur(&self.surface.shares[node as usize].centre),
            )
        };
        let press = |node| self.press(node, &self.pose, &angular, &linear);
        tractions.extend(self.candidates.near(gap_mm).filter_map(press));
        self.tractions = tractions;
        let rubbing = self.rubbing();
        let mut total = Vec6::zeros();
        for traction in &self.tractions {
            total += wrench(&traction.place, &traction.force_n(&rubbing));
        }
        to_femur.tr_mul(&total)
    }

    fn tangent(&self) -> Tangent {
        let rubbing = self.rubbing();
        let (mut by_pose, mut by_twist) = (Mat6::zeros(), Mat6::zeros());
        for traction in &self.tractions {
            traction.add_tangent(&rubbing, &mut by_pose, &mut by_twist);
        }
        let to_femur = twist_to_femur(&self.pose);
        Tangent {
            by_pose: to_femur.tr_mul(&by_pose) * to_femur,
            by_twist: to_femur.tr_mul(&by_twist) * to_femur,
        }
    }

    fn node_count(&self) -> usize {
        self.surface.positions.len()
    }

    fn touched(&self) -> Vec<TouchedNode> {
        let rubbing = self.rubbing();
        let touched = |traction: &Traction| {
            let node = traction.node as usize;
            let sliding = self.pose.rotation * traction.along * traction.sliding_mm_per_s;
            TouchedNode {
                node: traction.node,
                is_medial: self.surface.positions[node].z < 0.0,
                pressure_mpa: traction.pressure_mpa,
                covered_mm2: traction.covered_mm2,
                force_n: self.pose.rotation * traction.force_n(&rubbing),
                sliding_mm_per_s: self.directions[node].map(|direction| sliding.dot(&direction)),
            }
        };
        self.tractions.iter().map(touched).collect()
    }
}
