//! Which nodes may touch: each is looked at again only when it could have come near.

use super::{Pose, traction::Tractions4};
use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, Share},
    number::{LANES, Lanes, Number},
};

/// Nearer than this a gap is a true distance with a true normal, mm; further off, a mesh's field
/// only bounds it.
const TRUE_GAP_MM: f64 = 2.0;

/// What the slope of a gap may exceed 1 by, where a distance field is only nearly one.
const GAP_PER_MOTION: f64 = 1.05;

/// What the mean gap of a share may differ from the gap at its centre, mm.
const SPREAD_MM: f64 = 0.02;

/// Four nodes' shares, side by side; a lane too many repeats the last node without area.
pub(super) struct Shares4 {
    pub nodes: [u32; LANES],
    pub centre: Vector<Lanes>,
    pub edge_a: Vector<Lanes>,
    pub edge_b: Vector<Lanes>,
    pub area_mm2: Lanes,
    pub spread_mm2: Lanes,
    pub thickness_mm: Lanes,
}

/// How to look at four shares.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    /// They touched last time, or were never looked at: press at once.
    Press,
    /// They did not touch: what was found then may rule out contact still.
    Search,
}

/// What a press of four shares that did not touch found.
#[derive(Clone)]
struct Found {
    place: Vector<Lanes>,
    normal: Vector<Lanes>,
    gap_mm: Lanes,
    /// Largest reach, less the growth until then, mm: with the growth now it bounds the reach now.
    reach_less_growth_mm: f64,
}

impl Found {
    fn nothing() -> Self {
        let zero = Vector::repeat(Lanes::splat(0.0));
        Self {
            place: zero,
            normal: zero,
            gap_mm: Lanes::splat(0.0),
            reach_less_growth_mm: 0.0,
        }
    }
}

/// How far every four shares are from touching, at least.
///
/// A gap changes no faster than its point moves in the femoral frame, nor does the reach of a
/// share. So four shares found `d` away from contact need no look before the femur has travelled
/// by `d` since, and what is looked at is exactly what a search over all nodes would find.
pub(super) struct Nearness {
    /// Travel at which each four are due for the next look, mm.
    due_mm: Vec<f64>,
    /// What the last press of each four found.
    found: Vec<Found>,
    /// Travel of the femur so far: a bound for every share, mm.
    travelled_mm: f64,
    /// What the reach of a share may have grown by so far, mm.
    reach_growth_mm: f64,
    /// Largest curvature of the femur, 1/mm: how fast its normal may turn.
    sharpest_per_mm: f64,
    at: Option<Pose>,
    /// Corners of the box around all shares.
    box_corners: [Vec3; 8],
    longest_half_mm: f64,
}

impl Nearness {
    pub fn new(surface: &ArticulatingSurface, count: usize, sharpest_per_mm: f64) -> Self {
        Self {
            due_mm: vec![f64::NEG_INFINITY; count],
            found: vec![Found::nothing(); count],
            travelled_mm: 0.0,
            reach_growth_mm: 0.0,
            sharpest_per_mm,
            at: None,
            box_corners: box_corners(&surface.shares),
            longest_half_mm: surface.shares.iter().map(half_mm).fold(0.0, f64::max),
        }
    }

    /// The femur moves on.
    ///
    /// The motion of a point is affine in its place, so it is longest at a corner of the box. A
    /// share's reach, half its rise over both edges, grows with the turn and the curvature.
    pub fn travel(&mut self, to: &Pose) {
        if let Some(from) = self.at.replace(*to) {
            let moved =
                |corner: &Vec3| (to.to_femur(corner) - from.to_femur(corner)).norm_squared();
            let farthest_mm = self
                .box_corners
                .iter()
                .map(moved)
                .fold(0.0, f64::max)
                .sqrt();
            let turn_rad = (to.rotation - from.rotation).norm();
            let reach_mm = self.longest_half_mm * (turn_rad + farthest_mm * self.sharpest_per_mm);
            self.reach_growth_mm += reach_mm;
            self.travelled_mm += GAP_PER_MOTION * farthest_mm + reach_mm;
        }
    }

    /// Whether four are due for a look, and for which.
    #[inline(always)]
    pub fn look(&self, four: usize) -> Option<Look> {
        let due_mm = self.due_mm[four];
        if due_mm > self.travelled_mm {
            None
        } else if due_mm == f64::NEG_INFINITY {
            Some(Look::Press)
        } else {
            Some(Look::Search)
        }
    }

    /// Whether what the last press found rules out contact at the places where the shares are now.
    ///
    /// Gaps change by n . d for a motion d, but for the turning of the normal on the way, at most
    /// d^2 / 2 times the sharpest curvature: far less than d itself where the femur slides past.
    #[inline(always)]
    pub fn is_far(&mut self, four: usize, place: &Vector<Lanes>) -> bool {
        let found = &self.found[four];
        let motion = place - found.place;
        let turning = motion.dot(&motion) * Lanes::splat(self.sharpest_per_mm / 2.0);
        let gap_mm = found.gap_mm + found.normal.dot(&motion) - turning;
        let reach_mm =
            (found.reach_less_growth_mm + self.reach_growth_mm).min(self.longest_half_mm);
        let to_contact_mm = gap_mm.least() - reach_mm - SPREAD_MM;
        let is_far = to_contact_mm > 0.0 && found.gap_mm.least() < TRUE_GAP_MM;
        if is_far {
            self.due_mm[four] = self.travelled_mm + to_contact_mm;
        }
        is_far
    }

    /// Notes what a press has found; says whether anything touches.
    #[inline(always)]
    pub fn found(
        &mut self,
        four: usize,
        tractions: &Tractions4,
        gap_mm: Lanes,
        reach_mm: Lanes,
    ) -> bool {
        let to_contact_mm = (gap_mm - reach_mm).least();
        if to_contact_mm <= 0.0 {
            self.due_mm[four] = f64::NEG_INFINITY;
            return true;
        }
        self.due_mm[four] = self.travelled_mm + to_contact_mm;
        self.found[four] = Found {
            place: tractions.place,
            normal: tractions.normal,
            gap_mm,
            reach_less_growth_mm: -(-reach_mm).least() - self.reach_growth_mm,
        };
        false
    }
}

impl Shares4 {
    /// All shares of a surface, four at a time in the order of the nodes.
    pub fn of(surface: &ArticulatingSurface, thickness_mm: &[f64]) -> Vec<Self> {
        let count = surface.shares.len() as u32;
        let first = (0..count).step_by(LANES);
        first
            .map(|first| Self::new(first, &surface.shares, thickness_mm))
            .collect()
    }

    fn new(first: u32, shares: &[Share], thickness_mm: &[f64]) -> Self {
        let last = shares.len() as u32 - 1;
        let nodes: [u32; LANES] = std::array::from_fn(|lane| (first + lane as u32).min(last));
        let share = |lane: usize| &shares[nodes[lane] as usize];
        let is_surplus = |lane: usize| first + lane as u32 > last;
        let vector = |of: fn(&Share) -> &Vec3| {
            Vector::from([0, 1, 2].map(|axis| Lanes::from_lanes(|lane| of(share(lane))[axis])))
        };
        Self {
            nodes,
            centre: vector(|share| &share.centre),
            edge_a: vector(|share| &share.edge_a),
            edge_b: vector(|share| &share.edge_b),
            area_mm2: Lanes::from_lanes(|lane| {
                if is_surplus(lane) {
                    0.0
                } else {
                    share(lane).area_mm2
                }
            }),
            spread_mm2: Lanes::from_lanes(|lane| share(lane).spread_mm2),
            thickness_mm: Lanes::from_lanes(|lane| thickness_mm[nodes[lane] as usize]),
        }
    }
}

/// Half of both edges of a share: how far its corners can lie from its centre.
fn half_mm(share: &Share) -> f64 {
    (share.edge_a.norm() + share.edge_b.norm()) / 2.0
}

fn box_corners(shares: &[Share]) -> [Vec3; 8] {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let wider = |(low, high): (Vec3, Vec3), share: &Share| {
        (low.inf(&share.centre), high.sup(&share.centre))
    };
    let (low, high) = shares.iter().fold(none, wider);
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
