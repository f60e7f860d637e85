//! How far four shares each are from touching, counted from one place of the cycle.

use super::{Pose, shares::Shares4};
use crate::{
    Vec3,
    number::{Lanes, Number},
};

/// What the slope of a gap may exceed 1 by, where a distance field is only nearly one.
pub(super) const GAP_PER_MOTION: f64 = 1.05;

/// How many fours are compared at a time: the bits of a word.
const BLOCK: usize = 32;

/// What the femur travels past: the shares' bounds.
#[derive(Clone)]
pub(super) struct Bounds {
    /// Corners of the box around all centres.
    corners: [Vec3; 8],
    longest_half_mm: f64,
}

impl Bounds {
    pub fn of(shares: &[Shares4]) -> Self {
        Self {
            corners: box_corners(shares),
            longest_half_mm: shares.iter().map(|four| four.half_mm).fold(0.0, f64::max),
        }
    }

    /// How much nearer a motion of the femur can bring any share, mm.
    ///
    /// The motion of a point is affine in its place, so it is longest at a corner of the box. A
    /// turn of the femur lets the reach of a share grow by as much as it lifts its corners.
    fn travel_mm(&self, from: &Pose, to: &Pose) -> f64 {
        let moved = |corner: &Vec3| (to.to_femur(corner) - from.to_femur(corner)).norm_squared();
        let farthest_mm = self.corners.iter().map(moved).fold(0.0, f64::max).sqrt();
        let turn_rad = (to.rotation - from.rotation).norm();
        GAP_PER_MOTION * farthest_mm + self.longest_half_mm * turn_rad
    }
}

/// When every four shares are to be looked at again.
#[derive(Clone)]
pub(super) struct Standoff {
    /// Where the femur was last.
    at: Option<Pose>,
    /// Its travel so far: a bound for every share, mm.
    travelled_mm: f64,
    /// Travel at which each four are due for the next look, mm.
    due_mm: Vec<f64>,
}

impl Standoff {
    /// All of `count` fours are due.
    pub fn new(count: usize) -> Self {
        Self {
            at: None,
            travelled_mm: 0.0,
            due_mm: vec![f64::NEG_INFINITY; count],
        }
    }

    /// The femur moves on.
    pub fn travel(&mut self, to: &Pose, bounds: &Bounds) {
        if let Some(from) = self.at.replace(*to) {
            self.travelled_mm += bounds.travel_mm(&from, to);
        }
    }

    /// Lists the fours that are due, ascending.
    ///
    /// Few are, so they are compared many at a time.
    pub fn list_due(&self, due: &mut Vec<u32>) {
        due.clear();
        for (block, due_mm) in self.due_mm.chunks(BLOCK).enumerate() {
            let mut left = due_bits(due_mm, self.travelled_mm);
            while left != 0 {
                due.push((block * BLOCK) as u32 + left.trailing_zeros());
                left &= left - 1;
            }
        }
    }

    /// Whether four touched when they were looked at last, or never were.
    #[inline(always)]
    pub fn is_always_due(&self, four: usize) -> bool {
        self.due_mm[four] == f64::NEG_INFINITY
    }

    /// Four touch: they are always due.
    #[inline(always)]
    pub fn touches(&mut self, four: usize) {
        self.due_mm[four] = f64::NEG_INFINITY;
    }

    /// Four are due when the femur has travelled on by `ahead_mm`.
    #[inline(always)]
    pub fn put_off(&mut self, four: usize, ahead_mm: f64) {
        self.due_mm[four] = self.travelled_mm + ahead_mm;
    }

    /// Every four have come nearer, each by so much.
    pub fn come_nearer(&mut self, nearer_mm: &[f64]) {
        for (due_mm, nearer_mm) in self.due_mm.iter_mut().zip(nearer_mm) {
            *due_mm -= nearer_mm;
        }
    }
}

/// A bit for each of at most [`BLOCK`] that is due.
#[inline(always)]
fn due_bits(due_mm: &[f64], travelled_mm: f64) -> u32 {
    let mut bits = 0;
    for (place, &due_mm) in due_mm.iter().enumerate() {
        bits |= u32::from(due_mm <= travelled_mm) << place;
    }
    bits
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
