//! Which shares may touch: four are looked at again only when they could have come near.

use super::{
    Pose,
    clearance::Clearance,
    motion::Pose4,
    seen::Seen,
    shares::Shares4,
    standoff::{Bounds, GAP_PER_MOTION, Standoff},
};
use crate::{
    Mat3, Vector,
    geometry::Surroundings,
    number::{Lanes, Number},
    products::dot,
};

/// How far every four shares are from touching, at least.
///
/// A gap changes no faster than its point moves in the femoral frame, and the reach of a share no
/// faster than the normal there turns. So four shares found `d` away from contact need no look
/// before the femur has travelled by `d` since; and then a look at what was seen before is often
/// enough. What is left is exactly what a search over all nodes would find.
///
/// Every increment of the cycle has its own account of that. A cycle after, the femur is within
/// hundredths of a millimetre of where it was, and hardly any share is due but those that touch.
pub(super) struct Nearness {
    /// The accounts of the increments come to so far, but for the one that counts now.
    standoffs: Vec<Option<Standoff>>,
    now: Standoff,
    increment: usize,
    bounds: Bounds,
    clearances: Vec<Clearance>,
    /// Turns of the femur so far, rad.
    turned_rad: f64,
    rotation: Mat3,
    listed: Vec<u32>,
}

impl Nearness {
    pub fn new(shares: &[Shares4]) -> Self {
        Self {
            standoffs: Vec::new(),
            now: Standoff::new(shares.len()),
            increment: 0,
            bounds: Bounds::of(shares),
            clearances: vec![Clearance::unknown(); shares.len()],
            turned_rad: 0.0,
            rotation: Mat3::identity(),
            listed: Vec::new(),
        }
    }

    /// From now on the account of another increment counts; of one never come to, it begins with
    /// what is known now.
    pub fn begin_increment(&mut self, increment: usize) {
        if increment == self.increment {
            return;
        }
        let most = increment.max(self.increment);
        if most >= self.standoffs.len() {
            self.standoffs.resize(most + 1, None);
        }
        let kept = self.standoffs[increment].take();
        let next = kept.unwrap_or_else(|| self.now.clone());
        let left = std::mem::replace(&mut self.now, next);
        self.standoffs[self.increment] = Some(left);
        self.increment = increment;
    }

    /// The femur moves on.
    pub fn travel(&mut self, to: &Pose) {
        self.now.travel(to, &self.bounds);
        self.turned_rad += (to.rotation - self.rotation).norm();
        self.rotation = to.rotation;
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
        due.clear();
        self.now.list_due(&mut self.listed);
        for &four in &self.listed {
            let at = four as usize;
            let place = pose.to_femur(&shares[at].centre);
            if !self.now.is_always_due(at) {
                let clearance = &self.clearances[at];
                let half_mm = shares[at].half_mm;
                let clear_mm = clearance.least_mm(&place, half_mm, self.turned_rad);
                if clear_mm > 0.0 {
                    self.now.put_off(at, clearance.travel_mm(clear_mm, half_mm));
                    continue;
                }
            }
            due.push((four, place));
        }
    }

    /// Four touch: they are always due.
    #[inline(always)]
    pub fn touches(&mut self, four: usize) {
        self.now.touches(four);
        self.clearances[four].forget();
    }

    /// Four were seen apart, their gap larger than their reach: notes when they are due next.
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
        let clearance = Clearance::new(seen, reach_mm, shares, surroundings, self.turned_rad);
        let near_mm = clearance.travel_mm(clearance.clear_mm(), half_mm);
        let far_mm = seen.sample.gap_mm.least() - half_mm;
        self.now.put_off(four, near_mm.max(far_mm));
        self.clearances[four] = clearance;
    }

    /// What is still known when the shares have moved and changed a little.
    pub fn worn(mut self, before: &[Shares4], shares: &[Shares4]) -> Self {
        let fours = before.iter().zip(shares);
        let nearer_mm: Vec<f64> = fours
            .map(|(before, four)| nearer_mm(before, four))
            .collect();
        self.bounds = Bounds::of(shares);
        self.clearances.iter_mut().for_each(Clearance::forget);
        self.now.come_nearer(&nearer_mm);
        for standoff in self.standoffs.iter_mut().flatten() {
            standoff.come_nearer(&nearer_mm);
        }
        self
    }
}

/// How much nearer four shares may have come by a change of them, as a travel of the femur, mm.
///
/// The centre's motion counts as one of the femur. The reach changes by no more than half of what
/// the edges do; the other half is more than what the mean over the share does, and longer edges
/// through a turn of the normal.
fn nearer_mm(before: &Shares4, four: &Shares4) -> f64 {
    let change = |of: fn(&Shares4) -> &Vector<Lanes>| {
        let change = of(four) - of(before);
        dot(&change, &change).sqrt()
    };
    let edges = change(|four| &four.edge_a) + change(|four| &four.edge_b);
    (change(|four| &four.centre) * Lanes::splat(GAP_PER_MOTION) + edges).greatest()
}
