//! Forces of four shares under pressure, and their tangent as a sum of rank-one terms.

use super::{Mat6, Vec6, motion::Twist4, seen::Seen};
use crate::{
    Vector,
    number::{Lanes, Number},
    products::{cross, dot, scaled_plus},
};

/// A speed that leans the direction of sliding where nothing slides, mm/s; far below any slip.
const STANDSTILL_MM_PER_S: f64 = 1e-9;

/// Four shares under pressure and rubbed; all vectors in the femoral frame.
///
/// The force on the insert is f = L (n + mu s t1), L the area times the pressure, t1 the direction
/// of sliding, s = v_t/w and w = sqrt(v_t^2 + v0^2).
pub(super) struct Tractions4 {
    pub pressure_mpa: Lanes,
    /// Areas of the shares, mm2; their product with the pressure is the load L, N.
    pub area_mm2: Lanes,
    /// Areas of the parts of the shares that press, mm2.
    pub covered_mm2: Lanes,
    /// Derivatives of the loads by the motion of the femur's material there, N/mm.
    pub load_by_motion: Vector<Lanes>,
    /// Derivatives of the loads by a turn of the femur about the share, N/rad.
    pub load_by_turn: Vector<Lanes>,
    pub sliding: Sliding,
}

/// How the femur's material moves past a share.
pub(super) struct Sliding {
    /// Velocity along the surface, mm/s; where nothing slides, a lean so slight that it only gives
    /// a direction.
    pub velocity_mm_per_s: Vector<Lanes>,
    /// Square of the speed of sliding, v_t^2, mm2/s2.
    speed2: Lanes,
    /// Velocity of the femur's material out of the femur, c = n . v, mm/s.
    closing_mm_per_s: Lanes,
    /// One over the speed with the tolerance, 1/w, s/mm.
    per_regular: Lanes,
}

impl Sliding {
    /// Takes a velocity apart along a surface with normal `normal`.
    #[inline(always)]
    pub fn new(velocity: &Vector<Lanes>, normal: &Vector<Lanes>, tolerance_mm_per_s: f64) -> Self {
        let closing = dot(normal, velocity);
        let lean = Lanes::splat(STANDSTILL_MM_PER_S);
        let leaning = Vector::new(-(normal.y * lean), normal.x * lean, Lanes::splat(0.0));
        let tangential = scaled_plus(normal, -closing, &(velocity + leaning));
        let speed2 = dot(&tangential, &tangential);
        let regular2 = speed2 + Lanes::splat(tolerance_mm_per_s * tolerance_mm_per_s);
        Self {
            velocity_mm_per_s: tangential,
            speed2,
            closing_mm_per_s: closing,
            per_regular: Lanes::splat(1.0) / regular2.sqrt(),
        }
    }

    /// Direction of sliding t1, and the part s of full friction that is reached.
    #[inline(always)]
    fn direction_and_part(&self) -> (Vector<Lanes>, Lanes) {
        let least = Lanes::splat(f64::MIN_POSITIVE);
        let speed = Number::max(self.speed2, least).sqrt();
        (
            self.velocity_mm_per_s * (Lanes::splat(1.0) / speed),
            speed * self.per_regular,
        )
    }
}

type Six = [Lanes; 6];

/// The tangent of many shares: its columns are added up in lanes.
pub(super) struct TangentSum {
    by_pose: [Six; 6],
    by_twist: [Six; 6],
}

impl Tractions4 {
    /// Rises of the loads of shares at `place` by a short motion of the femur, turn and shift in
    /// its frame, N.
    #[inline(always)]
    pub fn load_rise_n(&self, place: &Vector<Lanes>, motion: &Twist4) -> Lanes {
        dot(&self.load_by_motion, &motion.velocity(place))
            + dot(&self.load_by_turn, motion.angular())
    }

    /// Forces on the insert under a femur with `normal`, N.
    #[inline(always)]
    pub fn force_n(&self, normal: &Vector<Lanes>, friction: f64) -> Vector<Lanes> {
        let rub = Lanes::splat(friction) * self.sliding.per_regular;
        let traction = scaled_plus(&self.sliding.velocity_mm_per_s, rub, normal);
        traction * (self.pressure_mpa * self.area_mm2)
    }
}

impl TangentSum {
    pub fn new() -> Self {
        let zero = [[Lanes::splat(0.0); 6]; 6];
        Self {
            by_pose: zero,
            by_twist: zero,
        }
    }

    /// Adds the derivatives of the wrench at the femur's origin by pose and by twist.
    ///
    /// A motion xi = (w, v) of the femur moves its material at the share by a = v + w x p and turns
    /// the normal by dn = w x n - K a, which lies in the plane of t1 and t2 = n x t1. With the
    /// wrenches N, T1, T2 of unit forces along n, t1, t2, and the rows R_i xi = -t_i . dn:
    ///
    /// dW = (N + mu s T1) dL - L (q1 T1 - mu s N) R_1 xi - L q2 T2 R_2 xi,
    /// q1 = 1 - mu c (1 - s^2)/w, q2 = 1 - mu c/w;
    ///
    /// and a change of twist tau: dW = L mu/w ((1 - s^2) T1 T1' + T2 T2') tau.
    #[inline(always)]
    pub fn add(&mut self, seen: &Seen, tractions: &Tractions4, friction: f64) {
        let sliding = &tractions.sliding;
        let (t1, part) = sliding.direction_and_part();
        let (p, n) = (&seen.place, &seen.sample.normal);
        let load = tractions.pressure_mpa * tractions.area_mm2;
        let t2 = cross(n, &t1);
        let wrench_n = joined(&cross(p, n), n);
        let wrench_1 = joined(&cross(p, &t1), &t1);
        let wrench_2 = joined(&cross(p, &t2), &t2);
        let row = |t: &Vector<Lanes>| {
            let bend = seen.sample.curvature.times(t);
            joined(&(cross(p, &bend) - cross(n, t)), &bend)
        };
        let load_row = joined(
            &(cross(p, &tractions.load_by_motion) + tractions.load_by_turn),
            &tractions.load_by_motion,
        );
        let (row_1, row_2) = (row(&t1), row(&t2));
        let (one, friction) = (Lanes::splat(1.0), Lanes::splat(friction));
        let (rub, stuck) = (friction * part, one - part * part);
        let per_speed = friction * sliding.per_regular;
        let turn = sliding.closing_mm_per_s * per_speed;
        let whole: Six = std::array::from_fn(|i| rub.times_plus(wrench_1[i], wrench_n[i]));
        let (q1, q2) = (load * (one - turn * stuck), load * (one - turn));
        let first: Six =
            std::array::from_fn(|i| (load * rub).times_minus(wrench_n[i], q1 * wrench_1[i]));
        let second: Six = std::array::from_fn(|i| -(q2 * wrench_2[i]));
        for (column, entries) in self.by_pose.iter_mut().enumerate() {
            for (i, entry) in entries.iter_mut().enumerate() {
                let by_load = whole[i].times_plus(load_row[column], *entry);
                let by_first = first[i].times_plus(row_1[column], by_load);
                *entry = second[i].times_plus(row_2[column], by_first);
            }
        }
        let (drag_1, drag_2) = (load * per_speed * stuck, load * per_speed);
        // Symmetric: one triangle is enough.
        for (column, entries) in self.by_twist.iter_mut().enumerate() {
            let (weight_1, weight_2) = (drag_1 * wrench_1[column], drag_2 * wrench_2[column]);
            for (i, entry) in entries.iter_mut().enumerate().take(column + 1) {
                let by_first = wrench_1[i].times_plus(weight_1, *entry);
                *entry = wrench_2[i].times_plus(weight_2, by_first);
            }
        }
    }

    /// The sums by pose and by twist.
    pub fn total(&self) -> (Mat6, Mat6) {
        let by_pose = Mat6::from_fn(|i, column| self.by_pose[column][i].sum());
        let by_twist = Mat6::from_fn(|i, column| self.by_twist[column.max(i)][column.min(i)].sum());
        (by_pose, by_twist)
    }
}

/// The wrench of many forces.
pub(super) struct WrenchSum(Six);

impl WrenchSum {
    pub fn new() -> Self {
        Self([Lanes::splat(0.0); 6])
    }

    /// Adds forces at places, about the origin.
    #[inline(always)]
    pub fn add(&mut self, place: &Vector<Lanes>, force: &Vector<Lanes>) {
        let wrench = joined(&cross(place, force), force);
        self.0
            .iter_mut()
            .zip(wrench)
            .for_each(|(sum, part)| *sum += part);
    }

    /// The sum.
    pub fn total(&self) -> Vec6 {
        Vec6::from(self.0.map(Lanes::sum))
    }
}

#[inline(always)]
fn joined(angular: &Vector<Lanes>, linear: &Vector<Lanes>) -> Six {
    [
        angular.x, angular.y, angular.z, linear.x, linear.y, linear.z,
    ]
}
