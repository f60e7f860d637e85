//! How far four shares are from touching, as long as what was seen of the femur still says so.

use super::{seen::Seen, shares::Shares4};
use crate::{
    Vector,
    geometry::Surroundings,
    number::{Lanes, Number},
    products::{dot, nowhere},
};

/// Four shares that were seen apart: from where, and how the gap goes on from there.
///
/// A gap g with gradient G and no second derivative below -h is, a motion d on, at least
/// g + G . d - h d^2/2. The reach of a share grows by its half edges times the turn of the normal:
/// K d on the femur, and the femur's own turn.
#[derive(Clone)]
pub(super) struct Clearance {
    place: Vector<Lanes>,
    gap_gradient: Vector<Lanes>,
    /// Gap less reach, and less how much the mean over a share may jump between two arcs, mm.
    clear_mm: Lanes,
    surroundings: Surroundings,
    turned_rad: f64,
}

impl Clearance {
    /// Nothing is known.
    pub fn unknown() -> Self {
        Self {
            place: nowhere(),
            gap_gradient: nowhere(),
            clear_mm: Lanes::splat(0.0),
            surroundings: Surroundings::UNKNOWN,
            turned_rad: 0.0,
        }
    }

    /// From now on nothing is known.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.surroundings.radius_mm = Surroundings::UNKNOWN.radius_mm;
    }

    /// What shares with a reach of `reach_mm` saw when the femur had turned by `turned_rad` in all.
    #[inline(always)]
    pub fn new(
        seen: &Seen,
        reach_mm: Lanes,
        shares: &Shares4,
        surroundings: Surroundings,
        turned_rad: f64,
    ) -> Self {
        let jump_mm = shares.spread_mm2 * Lanes::splat(surroundings.sharpest_per_mm);
        Self {
            place: seen.place,
            gap_gradient: seen.sample.gap_gradient,
            clear_mm: seen.sample.gap_mm - reach_mm - jump_mm,
            surroundings,
            turned_rad,
        }
    }

    /// How far from contact they were at least, mm.
    #[inline(always)]
    pub fn clear_mm(&self) -> f64 {
        self.clear_mm.least()
    }

    /// How far from contact the shares are at least, mm, at another place and turn; not above 0
    /// where that is not sure.
    #[inline(always)]
    pub fn least_mm(&self, place: &Vector<Lanes>, half_mm: f64, turned_rad: f64) -> f64 {
        let motion = place - self.place;
        let motion2 = dot(&motion, &motion).greatest();
        let Surroundings {
            radius_mm,
            sharpest_per_mm,
            hollow_per_mm,
        } = self.surroundings;
        let motion_mm = motion2.sqrt();
        if motion_mm > radius_mm {
            return 0.0;
        }
        let turn_rad = sharpest_per_mm * motion_mm + (turned_rad - self.turned_rad);
        let error_mm = 0.5 * hollow_per_mm * motion2 + half_mm * turn_rad;
        (self.clear_mm + dot(&self.gap_gradient, &motion)).least() - error_mm
    }

    /// How far the femur may travel before the shares, now `clear_mm` from contact, could touch, mm.
    #[inline(always)]
    pub fn travel_mm(&self, clear_mm: f64, half_mm: f64) -> f64 {
        clear_mm.min(self.surroundings.radius_mm)
            / (1.0 + half_mm * self.surroundings.sharpest_per_mm)
    }
}

#[cfg(test)]
mod tests;
