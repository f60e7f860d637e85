//! How far a block of shares is from touching, and how a motion of the femur brings it nearer.

use crate::{
    Vec3,
    contact::share_block::ShareBlock,
    geometry::{CurvatureBounds, MAX_GAP_SLOPE, SurfaceSample},
    number::vector::dot,
    number::{F64x4, LANES, Number},
};

/// Where a gap is smaller the curvature of the femur is known, mm; see [`CurvatureBounds`].
const KNOWN_MM: f64 = 1.5;

/// Those bounds hold at least this far around, mm.
const HOLDS_MM: f64 = 1.0;

/// More than an extrapolated sample errs in gap and reach, mm.
const EXTRAPOLATED_MM: f64 = 1e-4;

/// A bound on how far a block of shares is from touching, as a function of how the femur moves on.
///
/// A gap g with gradient G and no second derivative below -h is, a motion d on, at least
/// g + G . d - h d^2/2. The reach of a share, the overclosure that its highest corner has above its
/// middle, grows by its half edges times the turn of the normal: K d on the femur, and the femur's own
/// turn. What the shares of the block have in common is taken for all: the mean of their gradients, for
/// the motion of their middle.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct SeparationBound {
    /// Gap less reach, and less how much the mean over a share may jump between two arcs, mm.
    pub clear_mm: f64,
    /// Gradient of the gap by the middle's place in the femoral frame.
    pub slope: Vec3,
    /// What may be lost besides with each millimetre of motion.
    pub loss: f64,
    /// The motion that all this holds for, mm.
    pub radius_mm: f64,
}

impl SeparationBound {
    /// That of shares with a reach of `reach_mm` under a femur sampled as `sample`, whose gaps are
    /// larger than the reach.
    #[inline(always)]
    pub fn new(
        sample: &SurfaceSample<F64x4>,
        reach_mm: F64x4,
        shares: &ShareBlock,
        curvature: CurvatureBounds,
    ) -> Self {
        let CurvatureBounds {
            radius_mm,
            max_curvature_per_mm,
            concavity_per_mm,
            curvature_jump_per_mm,
        } = curvature;
        let gap_mm = sample.gap_mm;
        let clear_mm = gap_mm - reach_mm - shares.spread_mm2 * F64x4::splat(curvature_jump_per_mm);
        let by_turn = shares.half_mm * max_curvature_per_mm;
        if gap_mm.least() - shares.half_mm > radius_mm {
            // Where the curvature of one lane is not known, what all may lose is bounded by slopes
            // alone. A lane whose gap is small is known itself, and its own reach counts.
            let known_mm = if radius_mm < 0.0 { KNOWN_MM } else { 0.0 };
            let is_known = gap_mm - F64x4::splat(known_mm);
            let far_mm = gap_mm - F64x4::splat(shares.half_mm);
            let near_mm = -Number::max(-clear_mm, F64x4::splat(-HOLDS_MM));
            let clear_mm = is_known.below_zero(near_mm, far_mm).least();
            return Self::far(clear_mm - EXTRAPOLATED_MM, MAX_GAP_SLOPE + by_turn);
        }
        let gradient = &sample.gap_gradient;
        let slope = gradient.map(|lanes| lanes.sum() / LANES as f64);
        let lean = gradient - slope.map(F64x4::splat);
        let leaning = dot(&lean, &lean).greatest().sqrt();
        Self {
            clear_mm: clear_mm.least() - EXTRAPOLATED_MM,
            slope,
            loss: leaning + by_turn + 0.5 * concavity_per_mm * radius_mm,
            radius_mm,
        }
    }

    /// Far off, or where little is known: no gap changes faster than its point moves, and where
    /// nothing is known no reach is longer than half of both edges.
    fn far(clear_mm: f64, loss: f64) -> Self {
        Self {
            clear_mm,
            slope: Vec3::zeros(),
            loss,
            radius_mm: f64::INFINITY,
        }
    }
}
