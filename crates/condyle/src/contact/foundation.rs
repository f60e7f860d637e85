//! The elastic foundation: rigid bodies, and pressure from local overclosure.

use super::{
    ContactModel, ContactResponse, Mat6, Pose, PressureLaw, RelativeMotion, TouchedNode, Vec6,
    candidates::Candidates,
    motion::{cross_matrix, twist_to_femur},
    partial::mean_overclosure,
};
use crate::{
    Mat3, Vec3,
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
    touched: Vec<TouchedNode>,
}

/// A share under pressure; all vectors in the femoral frame.
struct Pressed {
    /// Place of the share's centre.
    place: Vec3,
    area_mm2: f64,
    normal: Vec3,
    curvature: Mat3,
    pressure_mpa: f64,
    /// Derivative of the pressure by the motion of the femur's material there.
    by_motion: Vec3,
    /// Derivative of the pressure by a turn of the femur about the share.
    by_turn: Vec3,
    /// Part of the share that presses.
    coverage: f64,
}

/// Force on the insert at a share and its derivatives; all in the femoral frame.
struct Traction {
    force: Vec3,
    by_motion: Mat3,
    by_turn: Mat3,
    by_velocity: Mat3,
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
            touched: Vec::new(),
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

    /// Pressure on one share, if any of it presses.
    ///
    /// With n the femur's normal, K its curvature, e_k the share's edges and W the mean
    /// overclosure of the share, a motion a and a turn w of the femur change the middle's
    /// overclosure by G . a, the normal by w x n - K a, and each rise n . e_k with the normal.
    #[inline]
    fn press(&self, node: usize, pose: &Pose) -> Option<Pressed> {
        let share = &self.surface.shares[node];
        let place = pose.to_femur(&share.centre);
        let sample = self.femur.sample(&place, share.spread_mm2);
        let normal_in_insert = pose.rotation * sample.normal;
        let rise = [
            normal_in_insert.dot(&share.edge_a),
            normal_in_insert.dot(&share.edge_b),
        ];
        let mean = mean_overclosure(-sample.gap_mm, rise)?;
        let (pressure_mpa, stiffness) =
            self.settings.law.pressure(mean.mm, self.thickness_mm[node]);
        let rise_change = pose
            .rotation
            .tr_mul(&(share.edge_a * mean.by_rise[0] + share.edge_b * mean.by_rise[1]));
        Some(Pressed {
            place,
            area_mm2: share.area_mm2,
            normal: sample.normal,
            curvature: sample.curvature,
            pressure_mpa,
            by_motion: (sample.gap_gradient * mean.by_middle
                - sample.curvature.tr_mul(&rise_change))
                * stiffness,
            by_turn: sample.normal.cross(&rise_change) * stiffness,
            coverage: mean.by_middle,
        })
    }

    /// Force of a pressed share under a velocity of the femur's material past it.
    ///
    /// f = A p (n + mu u), u = v_t/w, w = sqrt(v_t^2 + v0^2), v_t the velocity along the surface.
    /// With U = (1 - u u')/w, a turn dn of the normal changes u by -((n . v) U + n v'/w) dn and a
    /// change dv of the velocity changes it by U dv_t.
    #[inline]
    fn rub(&self, pressed: &Pressed, velocity: &Vec3) -> Traction {
        let Pressed {
            area_mm2,
            normal,
            curvature,
            pressure_mpa,
            ..
        } = pressed;
        let friction = self.settings.friction;
        let closing = normal.dot(velocity);
        let sliding = velocity - normal * closing;
        let w = (sliding.norm_squared() + self.settings.slip_tolerance_mm_per_s.powi(2)).sqrt();
        let u = sliding / w;
        let load = area_mm2 * pressure_mpa;
        let direction = normal + u * friction;
        let turning = (Mat3::identity() - u * u.transpose()) * (friction / w);
        let by_normal =
            Mat3::identity() - turning * closing - normal * velocity.transpose() * (friction / w);
        Traction {
            force: direction * load,
            by_motion: direction * (pressed.by_motion * *area_mm2).transpose()
                - by_normal * curvature * load,
            by_turn: direction * (pressed.by_turn * *area_mm2).transpose()
                - by_normal * cross_matrix(normal) * load,
            by_velocity: (turning - normal * normal.transpose() * (friction / w)) * load,
        }
    }

    fn touch(
        &self,
        node: u32,
        pressed: &Pressed,
        traction: &Traction,
        velocity: &Vec3,
        pose: &Pose,
    ) -> TouchedNode {
        let sliding = pose.rotation * (velocity - pressed.normal * pressed.normal.dot(velocity));
        TouchedNode {
            node,
            is_medial: self.surface.positions[node as usize].z < 0.0,
            pressure_mpa: pressed.pressure_mpa,
            covered_mm2: pressed.coverage * pressed.area_mm2,
            force_n: pose.rotation * traction.force,
            sliding_mm_per_s: self.directions[node as usize]
                .map(|direction| sliding.dot(&direction)),
        }
    }
}

impl ContactModel for Foundation<'_> {
    fn respond(&mut self, motion: &RelativeMotion) -> ContactResponse {
        let pose = &motion.pose;
        let to_femur = twist_to_femur(pose);
        let twist = to_femur * motion.twist;
        let (angular, linear): (Vec3, Vec3) = (
            twist.fixed_rows::<3>(0).into(),
            twist.fixed_rows::<3>(3).into(),
        );
        let mut total = ContactResponse::none();
        let candidates = self
            .candidates
            .at(pose, self.femur, &self.surface.shares)
            .to_vec();
        self.touched.clear();
        for node in candidates {
            let Some(pressed) = self.press(node as usize, pose) else {
                continue;
            };
            let velocity = linear + angular.cross(&pressed.place);
            let traction = self.rub(&pressed, &velocity);
            add(&mut total, &traction, &pressed.place);
            let touched = self.touch(node, &pressed, &traction, &velocity, pose);
            self.touched.push(touched);
        }
        ContactResponse {
            wrench: to_femur.tr_mul(&total.wrench),
            by_pose: to_femur.tr_mul(&total.by_pose) * to_femur,
            by_twist: to_femur.tr_mul(&total.by_twist) * to_femur,
        }
    }

    fn node_count(&self) -> usize {
        self.surface.positions.len()
    }

    fn touched(&self) -> &[TouchedNode] {
        &self.touched
    }
}

/// Adds a traction at `place` to the response at the origin: a = v + w x place, m = place x f.
#[inline]
fn add(total: &mut ContactResponse, traction: &Traction, place: &Vec3) {
    let lever = cross_matrix(place);
    let moment = place.cross(&traction.force);
    total.wrench += Vec6::new(
        moment.x,
        moment.y,
        moment.z,
        traction.force.x,
        traction.force.y,
        traction.force.z,
    );
    let by_motion = traction.by_motion;
    add_blocks(
        &mut total.by_pose,
        &lever,
        &(traction.by_turn - by_motion * lever),
        &by_motion,
    );
    let by_velocity = traction.by_velocity;
    add_blocks(
        &mut total.by_twist,
        &lever,
        &(-by_velocity * lever),
        &by_velocity,
    );
}

/// Adds the force's derivatives by (angular, linear), and the moment's with the lever.
#[inline]
fn add_blocks(total: &mut Mat6, lever: &Mat3, by_angular: &Mat3, by_linear: &Mat3) {
    let blocks = [
        (0, 0, lever * by_angular),
        (0, 3, lever * by_linear),
        (3, 0, *by_angular),
        (3, 3, *by_linear),
    ];
    for (row, column, block) in blocks {
        let mut place = total.fixed_view_mut::<3, 3>(row, column);
        place += block;
    }
}
