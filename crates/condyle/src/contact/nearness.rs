//! Which shares may touch: four are looked at again only when they could have come near.

use super::{Pose, clearance::Clearance, motion::Pose4, seen::Seen, shares::Shares4};
use crate::{
    Vec3, Vector,
    geometry::Surroundings,
    number::{Lanes, Number},
};

/// What the slope of a gap may exceed 1 by, where a distance field is only nearly one.
const GAP_PER_MOTION: f64 = 1.05;

/// How far ahead the fours that are due soon are listed, mm of travel.
const AHEAD_MM: f64 = 0.05;

/// How far every four shares are from touching, at least.
///
/// A gap changes no faster than its point moves in the femoral frame, and the reach of a share no
/// faster than the normal there turns. So four shares found `d` away from contact need no look
/// before the femur has travelled by `d` since; and then a look at what was seen before is often
/// enough. What is left is exactly what a search over all nodes would find.
pub(super) struct Nearness {
    /// Travel at which each four are due for the next look, mm.
    due_mm: Vec<f64>,
    clearances: Vec<Clearance>,
    /// The fours that are due before the femur has travelled to `horizon_mm`.
    near: Vec<u32>,
    horizon_mm: f64,
    /// Travel of the femur so far: a bound for every share, mm.
    travelled_mm: f64,
    /// Turns of the femur so far, rad.
    turned_rad: f64,
    at: Option<Pose>,
    /// Corners of the box around all shares.
    box_corners: [Vec3; 8],
    longest_half_mm: f64,
}

impl Nearness {
    pub fn new(shares: &[Shares4]) -> Self {
        Self {
            due_mm: vec![f64::NEG_INFINITY; shares.len()],
            clearances: vec![Clearance::unknown(); shares.len()],
            near: Vec::new(),
            horizon_mm: f64::NEG_INFINITY,
            travelled_mm: 0.0,
            turned_rad: 0.0,
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
            self.turned_rad += turn_rad;
            self.travelled_mm += GAP_PER_MOTION * farthest_mm + self.longest_half_mm * turn_rad;
        }
    }

    /// Lists the fours that may touch at a pose, each with the places of its centres there.
    ///
    /// They are found first and looked at after: the processor goes through two short loops faster
    /// than through a long one, where every step waits for the one before.
    pub fn find_due(
        &mut self,
        shares: &[Shares4],
        pose: &Pose4,
        due: &mut Vec<(u32, Vector<Lanes>)>,
    ) {
        if self.travelled_mm > self.horizon_mm {
            self.find_near(shares, pose);
        }
        due.clear();
        for &four in &self.near {
            let at = four as usize;
            if self.due_mm[at] <= self.travelled_mm {
                due.push((four, pose.to_femur(&shares[at].centre)));
            }
        }
    }

    /// Lists the fours that are due soon.
    ///
    /// Newton's corrections are short: they go over this list, and not over all shares.
    fn find_near(&mut self, shares: &[Shares4], pose: &Pose4) {
        self.near.clear();
        self.horizon_mm = self.travelled_mm + AHEAD_MM;
        for (four, shares) in shares.iter().enumerate() {
            if self.due_mm[four] > self.horizon_mm {
                continue;
            }
            if self.due_mm[four] != f64::NEG_INFINITY {
                self.put_off(four, shares.half_mm, &pose.to_femur(&shares.centre));
            }
            if self.due_mm[four] <= self.horizon_mm {
                self.near.push(four as u32);
            }
        }
    }

    /// Puts the next look from four off if what was seen before says that they do not touch at
    /// `place` either.
    #[inline(always)]
    fn put_off(&mut self, four: usize, half_mm: f64, place: &Vector<Lanes>) {
        let clearance = &self.clearances[four];
        let clear_mm = clearance.least_mm(place, half_mm, self.turned_rad);
        if clear_mm > 0.0 {
            self.due_mm[four] = self.travelled_mm + clearance.travel_mm(clear_mm, half_mm);
        }
    }

    /// Four touch: they are always due.
    #[inline(always)]
    pub fn touches(&mut self, four: usize) {
        self.due_mm[four] = f64::NEG_INFINITY;
        self.clearances[four].forget();
    }

    /// Four were seen apart, their gap larger than their reach: notes when they are due
    /// next.
    ///
    /// Far off, where nothing is known of the surroundings, no reach is longer than half of both
    /// edges.
    #[inline(always)]
    pub fn is_apart(
        &mut self,
        four: usize,
        shares: &Shares4,
        seen: &Seen,
        reach_mm: Lanes,
        surroundings: Surroundings,
    ) {
        let half_mm = shares.half_mm;
        let gap_mm = seen.sample.gap_mm;
        let clearance = Clearance::new(seen, reach_mm, shares, surroundings, self.turned_rad);
        let near_mm = clearance.travel_mm((gap_mm - reach_mm).least(), half_mm);
        let far_mm = gap_mm.least() - half_mm;
        self.due_mm[four] = self.travelled_mm + near_mm.max(far_mm);
        self.clearances[four] = clearance;
    }
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
