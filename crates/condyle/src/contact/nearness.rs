//! Which shares may touch: four are looked at again only when they could have come near.

use super::{Pose, seen::Seen, shares::Shares4};
use crate::{
    Vec3,
    number::{Lanes, Number},
};

/// Nearer than this a gap is a true distance with a true normal, mm; further off, a mesh's field
/// only bounds it.
const TRUE_GAP_MM: f64 = 2.0;

/// Farther than this nothing is known of the surroundings of a look, mm.
const SURROUNDINGS_MM: f64 = 1.2;

/// What the slope of a gap may exceed 1 by, where a distance field is only nearly one.
const GAP_PER_MOTION: f64 = 1.05;

/// How far every four shares are from touching, at least.
///
/// A gap changes no faster than its point moves in the femoral frame, and the reach of a share no
/// faster than the normal there turns. So four shares found `d` away from contact need no look
/// before the femur has travelled by `d` since, and what is looked at is exactly what a search
/// over all nodes would find.
pub(super) struct Nearness {
    /// Travel at which each four are due for the next look, mm.
    due_mm: Vec<f64>,
    /// Travel of the femur so far: a bound for every share, mm.
    travelled_mm: f64,
    at: Option<Pose>,
    /// Corners of the box around all shares.
    box_corners: [Vec3; 8],
    longest_half_mm: f64,
}

impl Nearness {
    pub fn new(shares: &[Shares4]) -> Self {
        Self {
            due_mm: vec![f64::NEG_INFINITY; shares.len()],
            travelled_mm: 0.0,
            at: None,
            box_corners: box_corners(shares),
            longest_half_mm: shares.iter().map(|four| four.half_mm).fold(0.0, f64::max),
        }
    }

    /// The femur moves on.
    ///
    /// The motion of a point is affine in its place, so it is longest at a corner of the box. A
    /// turn of the femur lets the reach of a share grow by as much as it lifts its corners.
    pub fn travel(&mut self, to: &Pose) {
        if let Some(from) = self.at.replace(*to) {
            let moved =
                |corner: &Vec3| (to.to_femur(corner) - from.to_femur(corner)).norm_squared();
            let corners = self.box_corners.iter().map(moved);
            let farthest_mm = corners.fold(0.0, f64::max).sqrt();
            let turn_rad = (to.rotation - from.rotation).norm();
            self.travelled_mm += GAP_PER_MOTION * farthest_mm + self.longest_half_mm * turn_rad;
        }
    }

    /// Whether four are due for a look.
    #[inline(always)]
    pub fn is_due(&self, four: usize) -> bool {
        self.due_mm[four] <= self.travelled_mm
    }

    /// Four touch: they are always due.
    #[inline(always)]
    pub fn touches(&mut self, four: usize) {
        self.due_mm[four] = f64::NEG_INFINITY;
    }

    /// Four were found with a gap that exceeds their reach by `to_contact_mm` at least: notes when
    /// they are due next.
    ///
    /// Where the surface around is known, the normal turns by its sharpest curvature at most; far
    /// off, no reach is longer than half of both edges.
    #[inline(always)]
    pub fn is_apart(&mut self, four: usize, shares: &Shares4, seen: &Seen, to_contact_mm: f64) {
        let travel_mm = if seen.sample.gap_mm.least() < TRUE_GAP_MM {
            let turning = 1.0 + shares.half_mm * seen.surroundings.sharpest_per_mm.greatest();
            to_contact_mm.min(SURROUNDINGS_MM) / turning
        } else {
            seen.sample.gap_mm.least() - shares.half_mm
        };
        self.due_mm[four] = self.travelled_mm + travel_mm;
    }
}

/// How far from contact four shares are at least, mm, given what was seen where they were; nothing
/// sure where they have moved on too far.
///
/// Where the second derivatives of the gap vary by no more than r, a motion d errs by r d^2/2 in
/// the gap that they predict, by r d in the normal, and by their trace times the spread in the mean
/// over a share.
#[inline(always)]
pub(super) fn predicted_to_contact_mm(
    shares: &Shares4,
    seen: &Seen,
    motion2: Lanes,
    gap_mm: Lanes,
    reach_mm: Lanes,
) -> Option<f64> {
    let knows = seen.sample.gap_mm.least() < TRUE_GAP_MM
        && motion2.greatest() < SURROUNDINGS_MM * SURROUNDINGS_MM;
    if !knows {
        return None;
    }
    let range = seen.surroundings.bend_range_per_mm;
    let gap_error = range * (motion2 * Lanes::splat(0.5) + shares.spread_mm2 * Lanes::splat(2.0));
    let reach_error = range * motion2.sqrt() * Lanes::splat(shares.half_mm);
    let to_contact_mm = (gap_mm - reach_mm - gap_error - reach_error).least();
    (to_contact_mm > 0.0).then_some(to_contact_mm)
}

fn box_corners(shares: &[Shares4]) -> [Vec3; 8] {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let (low, high) = shares.iter().fold(none, |(low, high), four| {
        (
            low.inf(&four.centre.map(Lanes::least)),
            high.sup(&four.centre.map(Lanes::greatest)),
        )
    });
    [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: usize| {
        let pick = |axis: usize| {
            if corner >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}
