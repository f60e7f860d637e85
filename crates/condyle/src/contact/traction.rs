//! Force of one share under pressure, and its tangent as a sum of rank-one terms.

use super::{Mat6, Vec6};
use crate::{Mat3, Vec3};

/// Below this the direction of sliding is arbitrary, mm/s.
const STANDSTILL_MM_PER_S: f64 = 1e-12;

/// A share under pressure and rubbed; all vectors in the femoral frame.
///
/// The force on the insert is f = L (n + mu s t1), L the area times the pressure, t1 the direction
/// of sliding, s = v_t/w and w = sqrt(v_t^2 + v0^2).
#[derive(Clone, Debug)]
pub(super) struct Traction {
    pub node: u32,
    /// Place of the share's centre, mm.
    pub place: Vec3,
    /// Unit normal of the femur.
    pub normal: Vec3,
    /// Curvature of the femur, 1/mm; right on tangents.
    pub curvature: Mat3,
    pub pressure_mpa: f64,
    /// Area of the share times its pressure, N.
    pub load_n: f64,
    /// Area of the part of the share that presses, mm2.
    pub covered_mm2: f64,
    /// Derivative of the load by the motion of the femur's material there, N/mm.
    pub load_by_motion: Vec3,
    /// Derivative of the load by a turn of the femur about the share, N/rad.
    pub load_by_turn: Vec3,
    /// Direction of sliding, t1.
    pub along: Vec3,
    /// Speed of sliding, v_t, mm/s.
    pub sliding_mm_per_s: f64,
    /// Velocity of the femur's material out of the femur, c = n . v, mm/s.
    pub closing_mm_per_s: f64,
}

/// How the surfaces rub.
#[derive(Clone, Copy)]
pub(super) struct Rubbing {
    pub friction: f64,
    pub slip_tolerance_mm_per_s: f64,
}

impl Rubbing {
    /// Speed with the tolerance, w, and the part s of full friction that is reached.
    #[inline]
    fn at(&self, sliding_mm_per_s: f64) -> (f64, f64) {
        let w = (sliding_mm_per_s.powi(2) + self.slip_tolerance_mm_per_s.powi(2)).sqrt();
        (w, sliding_mm_per_s / w)
    }
}

/// Direction and speed of sliding, and closing speed, of a velocity past a surface.
#[inline]
pub(super) fn split_velocity(velocity: &Vec3, normal: &Vec3) -> (Vec3, f64, f64) {
    let closing = normal.dot(velocity);
    let sliding = velocity - normal * closing;
    let speed = sliding.norm();
    if speed > STANDSTILL_MM_PER_S {
        (sliding / speed, speed, closing)
    } else {
        (some_tangent(normal), 0.0, closing)
    }
}

fn some_tangent(normal: &Vec3) -> Vec3 {
    let other = if normal.x.abs() < 0.9 {
        Vec3::x()
    } else {
        Vec3::y()
    };
    normal.cross(&other).normalize()
}

impl Traction {
    /// Force on the insert, N.
    #[inline]
    pub fn force_n(&self, rubbing: &Rubbing) -> Vec3 {
        let (_, part) = rubbing.at(self.sliding_mm_per_s);
        (self.normal + self.along * (rubbing.friction * part)) * self.load_n
    }

    /// Adds the derivatives of the wrench at the femur's origin by pose and by twist.
    ///
    /// A motion xi = (w, v) of the femur moves its material at the share by a = v + w x p and turns
    /// the normal by dn = w x n - K a, which lies in the plane of t1 and t2 = n x t1. With the
    /// wrenches N, T1, T2 of unit forces along n, t1, t2, and the rows R_i = -t_i . dn/dxi:
    ///
    /// dW = (N + mu s T1) dL - L (q1 T1 - mu s N) R_1 xi - L q2 T2 R_2 xi,
    /// q1 = 1 - mu c (1 - s^2)/w, q2 = 1 - mu c/w;
    ///
    /// and a change of twist tau: dW = L mu/w ((1 - s^2) T1 T1' + T2 T2') tau.
    #[inline]
    pub fn add_tangent(&self, rubbing: &Rubbing, by_pose: &mut Mat6, by_twist: &mut Mat6) {
        let (w, part) = rubbing.at(self.sliding_mm_per_s);
        let friction = rubbing.friction;
        let (p, n, t1) = (&self.place, &self.normal, &self.along);
        let t2 = n.cross(t1);
        let [wrench_n, wrench_1, wrench_2] = [n, t1, &t2].map(|force| unit_wrench(p, force));
        let row = |t: &Vec3| {
            let bend = self.curvature * t;
            joined(&(p.cross(&bend) - n.cross(t)), &bend)
        };
        let load_row = joined(
            &(p.cross(&self.load_by_motion) + self.load_by_turn),
            &self.load_by_motion,
        );
        let (rub, stuck) = (friction * part, 1.0 - part * part);
        let turn = friction * self.closing_mm_per_s / w;
        let load = self.load_n;
        let first = scaled(
            &wrench_1,
            -load * (1.0 - turn * stuck),
            &wrench_n,
            load * rub,
        );
        let second = scaled(&wrench_2, -load * (1.0 - turn), &wrench_n, 0.0);
        add_outer(by_pose, &scaled(&wrench_n, 1.0, &wrench_1, rub), &load_row);
        add_outer(by_pose, &first, &row(t1));
        add_outer(by_pose, &second, &row(&t2));
        let drag = load * friction / w;
        add_outer(
            by_twist,
            &scaled(&wrench_1, drag * stuck, &wrench_1, 0.0),
            &wrench_1,
        );
        add_outer(
            by_twist,
            &scaled(&wrench_2, drag, &wrench_2, 0.0),
            &wrench_2,
        );
    }
}

type Six = [f64; 6];

#[inline]
fn joined(angular: &Vec3, linear: &Vec3) -> Six {
    [
        angular.x, angular.y, angular.z, linear.x, linear.y, linear.z,
    ]
}

/// Wrench at the origin of a force at `place`.
#[inline]
fn unit_wrench(place: &Vec3, force: &Vec3) -> Six {
    joined(&place.cross(force), force)
}

#[inline]
fn scaled(a: &Six, by_a: f64, b: &Six, by_b: f64) -> Six {
    std::array::from_fn(|i| a[i] * by_a + b[i] * by_b)
}

/// Adds a b' to the matrix; a column at a time, as it lies in memory.
#[inline]
fn add_outer(matrix: &mut Mat6, a: &Six, b: &Six) {
    for (column, &weight) in matrix.as_mut_slice().chunks_exact_mut(6).zip(b) {
        for (entry, &value) in column.iter_mut().zip(a) {
            *entry += value * weight;
        }
    }
}

/// Wrench at the femur's origin of a force at a share.
#[inline]
pub(super) fn wrench(place: &Vec3, force: &Vec3) -> Vec6 {
    Vec6::from(unit_wrench(place, force))
}
