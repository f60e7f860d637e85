//! The gap along the normals of the insert, on which the surface gives way.

use super::cholesky::Eight;
use crate::{
    Vector,
    contact::pressed::NearBlock,
    number::{
        F64x4, LANES, Number,
        vector::{cross, dot},
    },
};

/// Below this part of its size a gap's slope does not count as one along the normal: the femur stands on edge there.
const MIN_SLOPE: f64 = 0.3;

/// How the gaps of a block of nodes change along the insert's normals there.
///
/// A node that gives way by w along its inward normal m opens the gap g of the bodies at rest to g + s w, with
/// s = G . m and G the gradient of the gap. So the bodies touch where the overclosure -g/s is given way by, and a load
/// N along m is the part there of a force N/s along the femur's normal: both do the same work.
pub(super) struct AlongNormal {
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
