//! Forces of four shares under pressure.

use super::{Vec6, motion::Twist4};
use crate::{
    Vec3, Vector,
    number::{Lanes, Number},
    products::{cross, dot, nowhere, scaled_plus},
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
    /// Velocity of the femur's material out of the femur, c = n . v, mm/s.
    pub closing_mm_per_s: Lanes,
    /// One over the speed with the tolerance, 1/w, s/mm.
    pub per_regular: Lanes,
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
            closing_mm_per_s: closing,
            per_regular: Lanes::splat(1.0) / regular2.sqrt(),
        }
    }
}

impl Tractions4 {
    /// Shares that nothing presses.
    pub fn none() -> Self {
        let zero = Lanes::splat(0.0);
        Self {
            pressure_mpa: zero,
            area_mm2: zero,
            covered_mm2: zero,
            load_by_motion: nowhere(),
            load_by_turn: nowhere(),
            sliding: Sliding {
                velocity_mm_per_s: nowhere(),
                closing_mm_per_s: zero,
                per_regular: zero,
            },
        }
    }

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

/// The wrench of many forces.
pub(super) struct WrenchSum([Lanes; 6]);

impl WrenchSum {
    pub fn new() -> Self {
        Self([Lanes::splat(0.0); 6])
    }

    /// Adds forces at places, about the origin.
    #[inline(always)]
    pub fn add(&mut self, place: &Vector<Lanes>, force: &Vector<Lanes>) {
        let moment = cross(place, force);
        let wrench = [moment.x, moment.y, moment.z, force.x, force.y, force.z];
        for (sum, part) in self.0.iter_mut().zip(&wrench) {
            *sum += *part;
        }
    }

    /// The sum.
    pub fn total(&self) -> Vec6 {
        Vec6::from(self.0.map(Lanes::sum))
    }
}

/// Slip of many shares weighted by their loads, on the medial and on the lateral side.
pub(super) struct SlipSums([(Lanes, Vector<Lanes>); 2]);

impl SlipSums {
    pub fn new() -> Self {
        Self([(Lanes::splat(0.0), nowhere()); 2])
    }

    /// Adds shares at `z`; the medial side is where it is negative.
    #[inline(always)]
    pub fn add(&mut self, z: Lanes, pressed: &Tractions4) {
        let (zero, load) = (Lanes::splat(0.0), pressed.pressure_mpa * pressed.area_mm2);
        let velocity = &pressed.sliding.velocity_mm_per_s;
        let mut add = |side: usize, load: Lanes| {
            let (loads, slips) = &mut self.0[side];
            *loads += load;
            *slips = scaled_plus(velocity, load, slips);
        };
        add(0, z.below_zero(load, zero));
        add(1, z.below_zero(zero, load));
    }

    /// The mean of each side, mm/s; none where nothing is loaded.
    pub fn means(&self) -> [Vec3; 2] {
        let mean = |side: usize| {
            let (loads, slips) = &self.0[side];
            slips.map(Lanes::sum) / loads.sum().max(f64::MIN_POSITIVE)
        };
        [mean(0), mean(1)]
    }
}
