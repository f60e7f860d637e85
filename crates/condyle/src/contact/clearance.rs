//! How far four shares are from touching, and how a motion of the femur brings them nearer.

use super::{seen::Seen, shares::Shares4};
use crate::{
    Vec3,
    geometry::Surroundings,
    number::{LANES, Lanes, Number},
    products::dot,
};

/// What the slope of a gap may exceed 1 by, where a distance field is only nearly one.
pub(super) const GAP_PER_MOTION: f64 = 1.05;

/// More than a sample moved along (see [`Seen`]) errs in gap and reach, mm.
const ASTRAY_MM: f64 = 1e-4;

/// Four shares that were seen apart: a bound on how far they are from touching, as a function of
/// how the femur moves on.
///
/// A gap g with gradient G and no second derivative below -h is, a motion d on, at least
/// g + G . d - h d^2/2. The reach of a share grows by its half edges times the turn of the normal:
/// K d on the femur, and the femur's own turn. What four shares have in common is taken for all:
/// the mean of their gradients, for the motion of their middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clearance {
    /// Gap less reach, and less how much the mean over a share may jump between two arcs, mm.
    pub clear_mm: f64,
    /// Gradient of the gap by the middle's place in the femoral frame.
    pub slope: Vec3,
    /// What may be lost beside with each millimetre of motion.
    pub loss: f64,
    /// The motion that all this holds for, mm.
    pub radius_mm: f64,
}

impl Clearance {
    /// What shares with a reach of `reach_mm` saw, their gap being larger than that.
    #[inline(always)]
    pub fn new(seen: &Seen, reach_mm: Lanes, shares: &Shares4, surroundings: Surroundings) -> Self {
        let far_mm = seen.sample.gap_mm.least() - shares.half_mm;
        if far_mm > surroundings.radius_mm {
            return Self::far(far_mm);
        }
        let Surroundings {
            radius_mm,
            sharpest_per_mm,
            hollow_per_mm,
            jump_per_mm,
        } = surroundings;
        let jump_mm = shares.spread_mm2 * Lanes::splat(jump_per_mm);
        let gradient = &seen.sample.gap_gradient;
        let slope = gradient.map(|lanes| lanes.sum() / LANES as f64);
        let lean = gradient - slope.map(Lanes::splat);
        let leaning = dot(&lean, &lean).greatest().sqrt();
        Self {
            clear_mm: (seen.sample.gap_mm - reach_mm - jump_mm).least() - ASTRAY_MM,
            slope,
            loss: leaning + shares.half_mm * sharpest_per_mm + 0.5 * hollow_per_mm * radius_mm,
            radius_mm,
        }
    }

    /// Far off, where nothing is known of the surroundings: no reach is longer than half of both
    /// edges, and no gap changes faster than its point moves.
    fn far(clear_mm: f64) -> Self {
        Self {
            clear_mm,
            slope: Vec3::zeros(),
            loss: GAP_PER_MOTION,
            radius_mm: f64::INFINITY,
        }
    }
}
