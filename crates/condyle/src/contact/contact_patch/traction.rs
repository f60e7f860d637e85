//! Tractions on a block of shares, and the sum of their derivatives.

use std::array::from_fn;

use super::near_blocks::CachedSample;
use crate::{
    Vector,
    geometry::Curvature,
    number::{F32x8, F64x4, Number, cross, dot, scale_add, zero_vector},
    spatial::{Mat6, Twist4},
};

/// A speed added to every velocity, mm/s; far below any slip. It gives a direction of sliding where nothing slides, which
/// the tangent needs.
const STANDSTILL_MM_PER_S: f64 = 1e-9;

/// The tractions on a block of four shares; all vectors in the counterface frame.
///
/// The force on the insert is f = L (n + mu s t1), L the area times the pressure, t1 the direction
/// of sliding, s = v_t/w and w = sqrt(v_t^2 + v0^2).
pub(crate) struct Tractions4 {
    pub pressure_mpa: F64x4,
    /// Areas of the shares, mm2; their product with the pressure is the load L, N.
    pub area_mm2: F64x4,
    /// Areas of the parts of the shares in contact, mm2.
    pub covered_mm2: F64x4,
    /// Derivatives of the loads by the motion of the counterface's material there, N/mm.
    pub load_by_motion: Vector<F64x4>,
    /// Derivatives of the loads by a turn of the counterface about the share, N/rad.
    pub load_by_turn: Vector<F64x4>,
    pub sliding: Sliding,
}

/// The motion of the counterface's material past a share.
pub(crate) struct Sliding {
    /// Velocity along the surface, mm/s; never exactly zero.
    pub velocity_mm_per_s: Vector<F64x4>,
    /// Velocity of the counterface's material out of the counterface, c = n . v, mm/s.
    pub closing_mm_per_s: F64x4,
    /// One over the speed with the tolerance, 1/w, s/mm.
    pub per_regular: F64x4,
}

impl Sliding {
    /// Decomposes a velocity along and across the surface.
    #[inline(always)]
    pub fn new(velocity: &Vector<F64x4>, normal: &Vector<F64x4>, tolerance_mm_per_s: f64) -> Self {
        let closing = dot(normal, velocity);
        // Any vector along the surface will do for the lean; this one vanishes only for a normal along z.
        let lean = F64x4::splat(STANDSTILL_MM_PER_S);
        let leaning = Vector::new(-(normal.y * lean), normal.x * lean, F64x4::splat(0.0));
        let tangential = scale_add(normal, -closing, &(velocity + leaning));
        let speed2 = dot(&tangential, &tangential);
        let regular2 = speed2 + F64x4::splat(tolerance_mm_per_s * tolerance_mm_per_s);
        Self {
            velocity_mm_per_s: tangential,
            closing_mm_per_s: closing,
            per_regular: F64x4::splat(1.0) / regular2.sqrt(),
        }
    }
}

impl Tractions4 {
    pub fn none() -> Self {
        let zero = F64x4::splat(0.0);
        Self {
            pressure_mpa: zero,
            area_mm2: zero,
            covered_mm2: zero,
            load_by_motion: zero_vector(),
            load_by_turn: zero_vector(),
            sliding: Sliding {
                velocity_mm_per_s: zero_vector(),
                closing_mm_per_s: zero,
                per_regular: zero,
            },
        }
    }

    /// Returns the change of the loads of shares at `place` by a short motion of the counterface, turn and shift in
    /// its frame, N.
    #[inline(always)]
    pub fn load_change_n(&self, place: &Vector<F64x4>, motion: &Twist4) -> F64x4 {
        dot(&self.load_by_motion, &motion.velocity(place))
            + dot(&self.load_by_turn, &motion.angular)
    }

    /// Returns the forces on the insert under a counterface with `normal`, N.
    #[inline(always)]
    pub fn force_n(&self, normal: &Vector<F64x4>, friction: f64) -> Vector<F64x4> {
        let rub = F64x4::splat(friction) * self.sliding.per_regular;
        let traction = scale_add(&self.sliding.velocity_mm_per_s, rub, normal);
        traction * (self.pressure_mpa * self.area_mm2)
    }
}

/// Square of the smallest speed of sliding that is divided by, mm2/s2: below any that occurs.
const MIN_SPEED2: f64 = 1e-30;

type Six<T> = [T; 6];

/// The tangent of many shares, summed in lanes, column by column.
///
/// It is summed in single precision, eight shares at a time: a Newton correction that is accurate to six digits
/// leaves a millionth of the residual, and single precision halves the cost of the most expensive part of the sum.
pub(crate) struct TangentSum {
    by_pose: [Six<F32x8>; 6],
    by_twist: [Six<F32x8>; 6],
}

/// The quantities of eight shares that enter the tangent; see [`Tractions4`].
struct Facets {
    place: Vector<F32x8>,
    normal: Vector<F32x8>,
    curvature: Curvature<F32x8>,
    load_n: F32x8,
    load_by_motion: Vector<F32x8>,
    load_by_turn: Vector<F32x8>,
    velocity: Vector<F32x8>,
    closing: F32x8,
    per_regular: F32x8,
}

impl Facets {
    /// Converts two blocks of shares to single precision.
    #[inline(always)]
    fn pair(one: (&CachedSample, &Tractions4), other: (&CachedSample, &Tractions4)) -> Self {
        let of = |value: fn(&CachedSample, &Tractions4) -> F64x4| {
            F32x8::pair(value(one.0, one.1), value(other.0, other.1))
        };
        let vector = |value: fn(&CachedSample, &Tractions4) -> Vector<F64x4>| {
            value(one.0, one.1).zip_map(&value(other.0, other.1), F32x8::pair)
        };
        Self {
            place: vector(|cached, _| cached.place),
            normal: vector(|cached, _| cached.sample.normal),
            curvature: Curvature {
                xx: of(|cached, _| cached.sample.curvature.xx),
                yy: of(|cached, _| cached.sample.curvature.yy),
                zz: of(|cached, _| cached.sample.curvature.zz),
                xy: of(|cached, _| cached.sample.curvature.xy),
                xz: of(|cached, _| cached.sample.curvature.xz),
                yz: of(|cached, _| cached.sample.curvature.yz),
            },
            load_n: of(|_, tractions| tractions.pressure_mpa * tractions.area_mm2),
            load_by_motion: vector(|_, tractions| tractions.load_by_motion),
            load_by_turn: vector(|_, tractions| tractions.load_by_turn),
            velocity: vector(|_, tractions| tractions.sliding.velocity_mm_per_s),
            closing: of(|_, tractions| tractions.sliding.closing_mm_per_s),
            per_regular: of(|_, tractions| tractions.sliding.per_regular),
        }
    }
}

impl TangentSum {
    pub fn new() -> Self {
        let zero = [[F32x8::splat(0.0); 6]; 6];
        Self {
            by_pose: zero,
            by_twist: zero,
        }
    }

    /// Adds the derivatives of two blocks of shares: of the wrench about the counterface's origin, by pose and by twist.
    ///
    /// A motion xi = (w, v) of the counterface moves its material at the share by a = v + w x p and turns
    /// the normal by dn = w x n - K a, which lies in the plane of t1 and t2 = n x t1. With the
    /// wrenches N, T1, T2 of unit forces along n, t1, t2, and the rows R_i xi = -t_i . dn:
    ///
    /// dW = (N + mu s T1) dL - L (q1 T1 - mu s N) R_1 xi - L q2 T2 R_2 xi,
    /// q1 = 1 - mu c (1 - s^2)/w, q2 = 1 - mu c/w;
    ///
    /// and a change of twist tau: dW = L mu/w ((1 - s^2) T1 T1' + T2 T2') tau.
    // If this function were inlined, every call would move the entries of the sum between two places in memory.
    #[inline(never)]
    pub fn add(
        &mut self,
        one: (&CachedSample, &Tractions4),
        other: (&CachedSample, &Tractions4),
        friction: f64,
    ) {
        let (facets, friction) = (Facets::pair(one, other), F32x8::splat(friction));
        let Facets {
            place: p,
            normal: n,
            load_n: load,
            ..
        } = &facets;
        let one = F32x8::splat(1.0);
        // The lean of the sliding keeps the speed above zero, but for a normal along z.
        let speed2 = dot(&facets.velocity, &facets.velocity);
        let speed = Number::max(speed2, F32x8::splat(MIN_SPEED2)).sqrt();
        let t1 = facets.velocity * (one / speed);
        let t2 = cross(n, &t1);
        let wrench_n = joined(&cross(p, n), n);
        let wrench_1 = joined(&cross(p, &t1), &t1);
        let wrench_2 = joined(&cross(p, &t2), &t2);
        // n x t1 = t2 and n x t2 = -t1.
        let row = |t: &Vector<F32x8>, across: &Vector<F32x8>| {
            let bend = facets.curvature.times(t);
            joined(&(cross(p, &bend) - across), &bend)
        };
        let (row_1, row_2) = (row(&t1, &t2), row(&t2, &-t1));
        let load_row = joined(
            &(cross(p, &facets.load_by_motion) + facets.load_by_turn),
            &facets.load_by_motion,
        );
        let part = speed * facets.per_regular;
        let (rub, stuck) = (friction * part, one - part * part);
        let per_speed = friction * facets.per_regular;
        let turn = facets.closing * per_speed;
        let (q1, q2) = (*load * (one - turn * stuck), *load * (one - turn));
        let whole: Six<F32x8> = from_fn(|i| rub.mul_add(wrench_1[i], wrench_n[i]));
        let first: Six<F32x8> = from_fn(|i| (*load * rub).mul_sub(wrench_n[i], q1 * wrench_1[i]));
        let second: Six<F32x8> = from_fn(|i| -(q2 * wrench_2[i]));
        for (column, entries) in self.by_pose.iter_mut().enumerate() {
            for (i, entry) in entries.iter_mut().enumerate() {
                let by_load = whole[i].mul_add(load_row[column], *entry);
                let by_first = first[i].mul_add(row_1[column], by_load);
                *entry = second[i].mul_add(row_2[column], by_first);
            }
        }
        let (drag_1, drag_2) = (*load * per_speed * stuck, *load * per_speed);
        // The drag is symmetric: one triangle is enough.
        for (column, entries) in self.by_twist.iter_mut().enumerate() {
            let (weight_1, weight_2) = (drag_1 * wrench_1[column], drag_2 * wrench_2[column]);
            for (i, entry) in entries.iter_mut().enumerate().take(column + 1) {
                let by_first = wrench_1[i].mul_add(weight_1, *entry);
                *entry = wrench_2[i].mul_add(weight_2, by_first);
            }
        }
    }

    pub fn total(&self) -> (Mat6, Mat6) {
        let by_pose = Mat6::from_fn(|i, column| self.by_pose[column][i].sum());
        let by_twist = Mat6::from_fn(|i, column| self.by_twist[column.max(i)][column.min(i)].sum());
        (by_pose, by_twist)
    }
}

#[inline(always)]
fn joined<T: Number>(angular: &Vector<T>, linear: &Vector<T>) -> Six<T> {
    [
        angular.x, angular.y, angular.z, linear.x, linear.y, linear.z,
    ]
}
