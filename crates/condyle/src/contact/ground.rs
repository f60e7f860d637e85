//! Where shares of the insert are, and how they wear, in eights of fours.

use super::{clearance::GAP_PER_MOTION, shares::Shares4};
use crate::{
    Vec3, Vector,
    number::{LANES, Lanes, Number, SINGLES, Singles},
    products::dot,
};

/// Eight fours: what a clearance from a femur changes with, as that moves.
pub(super) struct Ground {
    /// The means of the four centres, mm.
    pub middles: Vector<Singles>,
    /// How much nearer a turn of the femur brings them beside, mm/rad: by how far a centre is from
    /// the middle, and the half edges.
    pub levers_mm: Singles,
}

/// How eight fours have worn.
pub(super) struct Wear {
    /// Motion of their middles, mm.
    pub moved: Vector<Singles>,
    /// Loss of clearance beside, mm.
    pub lost_mm: Singles,
}

/// How all have worn last.
pub(super) struct LastWear {
    /// How often they have worn.
    pub number: u32,
    pub eights: Vec<Wear>,
}

impl Ground {
    /// All shares of a surface.
    pub fn of(shares: &[Shares4]) -> Vec<Self> {
        shares.chunks(SINGLES).map(Self::new).collect()
    }

    fn new(fours: &[Shares4]) -> Self {
        let at = |i: usize| &fours[i.min(fours.len() - 1)];
        let axis = |axis: usize| Singles::from_lanes(|i| middle(at(i))[axis]);
        Self {
            middles: Vector::new(axis(0), axis(1), axis(2)),
            levers_mm: Singles::from_lanes(|i| lever_mm(at(i))),
        }
    }
}

impl Wear {
    /// All shares of a surface, from those before.
    pub fn between(before: &[Shares4], after: &[Shares4]) -> Vec<Self> {
        let eights = before.chunks(SINGLES).zip(after.chunks(SINGLES));
        eights
            .map(|(before, after)| Self::new(before, after))
            .collect()
    }

    fn new(before: &[Shares4], after: &[Shares4]) -> Self {
        let last = before.len() - 1;
        let at = |i: usize| (&before[i.min(last)], &after[i.min(last)]);
        let moved = |i: usize| {
            let (before, after) = at(i);
            middle(after) - middle(before)
        };
        let lost_mm = |i: usize| {
            let (before, after) = at(i);
            lost_mm(before, after, &moved(i))
        };
        let axis = |axis: usize| Singles::from_lanes(|i| moved(i)[axis]);
        Self {
            moved: Vector::new(axis(0), axis(1), axis(2)),
            lost_mm: Singles::from_lanes(lost_mm),
        }
    }
}

fn middle(four: &Shares4) -> Vec3 {
    four.centre.map(|lanes| lanes.sum() / LANES as f64)
}

fn lever_mm(four: &Shares4) -> f64 {
    four.half_mm + GAP_PER_MOTION * longest_mm(&(four.centre - middle(four).map(Lanes::splat)))
}

/// What wear of four shares whose middle moves by `moved` may take from their clearance beside, mm.
///
/// Each centre may move otherwise than the middle. The reach changes by no more than half of what
/// the edges do; a fifth of that is more than what the mean over the share does, and longer edges
/// through a turn of the normal.
fn lost_mm(before: &Shares4, after: &Shares4, moved: &Vec3) -> f64 {
    let astray = after.centre - before.centre - moved.map(Lanes::splat);
    let [by_a, by_b] = [after.edge_a - before.edge_a, after.edge_b - before.edge_b];
    GAP_PER_MOTION * longest_mm(&astray) + 0.6 * (longest_mm(&by_a) + longest_mm(&by_b))
}

fn longest_mm(vectors: &Vector<Lanes>) -> f64 {
    dot(vectors, vectors).greatest().sqrt()
}
