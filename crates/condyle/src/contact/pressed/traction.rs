//! Forces of a block of shares under pressure.

use crate::{
    Vector,
    number::{
        F64x4, Number,
        vector::{dot, scale_add, zero_vector},
    },
    spatial::Twist4,
};

/// A speed that leans the direction of sliding where nothing slides, mm/s; far below any slip.
const STANDSTILL_MM_PER_S: f64 = 1e-9;

/// Coulomb's law of friction, regularised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::contact) struct Coulomb {
    /// Coefficient of friction, mu.
    pub coefficient: f64,
    /// Speed at which friction has reached 71 % of its full value, v0, mm/s, > 0.
    pub slip_tolerance_mm_per_s: f64,
}

/// Four shares of nodes under pressure and rubbed; all vectors in the femoral frame.
///
/// The force on the insert is f = L (n + mu s t1), L the area times the pressure, t1 the direction
/// of sliding, s = v_t/w and w = sqrt(v_t^2 + v0^2).
pub(in crate::contact) struct Tractions4 {
    pub pressure_mpa: F64x4,
    /// Areas of the shares, mm2; their product with the pressure is the load L, N.
    pub area_mm2: F64x4,
    /// Areas of the parts of the shares that press, mm2.
    pub covered_mm2: F64x4,
    /// Derivatives of the loads by the motion of the femur's material there, N/mm.
    pub load_by_motion: Vector<F64x4>,
    /// Derivatives of the loads by a turn of the femur about the share, N/rad.
    pub load_by_turn: Vector<F64x4>,
    pub sliding: Sliding,
}

/// How the femur's material moves past a share.
pub(in crate::contact) struct Sliding {
    /// Velocity along the surface, mm/s; where nothing slides, a lean so slight that it only gives
    /// a direction.
    pub velocity_mm_per_s: Vector<F64x4>,
    /// Velocity of the femur's material out of the femur, c = n . v, mm/s.
    pub closing_mm_per_s: F64x4,
    /// One over the speed with the tolerance, 1/w, s/mm.
    pub per_regular: F64x4,
}

impl Sliding {
    /// Takes a velocity apart along a surface with normal `normal`.
    #[inline(always)]
    pub fn new(velocity: &Vector<F64x4>, normal: &Vector<F64x4>, tolerance_mm_per_s: f64) -> Self {
        let closing = dot(normal, velocity);
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
    /// Shares that nothing presses.
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

    /// How the loads of shares at `place` grow by a short motion of the femur, turn and shift in
    /// its frame, N.
    #[inline(always)]
    pub fn load_change_n(&self, place: &Vector<F64x4>, motion: &Twist4) -> F64x4 {
        dot(&self.load_by_motion, &motion.velocity(place))
            + dot(&self.load_by_turn, motion.angular())
    }

    /// Forces on the insert under a femur with `normal`, N.
    #[inline(always)]
    pub fn force_n(&self, normal: &Vector<F64x4>, friction: f64) -> Vector<F64x4> {
        let rub = F64x4::splat(friction) * self.sliding.per_regular;
        let traction = scale_add(&self.sliding.velocity_mm_per_s, rub, normal);
        traction * (self.pressure_mpa * self.area_mm2)
    }
}
