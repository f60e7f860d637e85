//! Where shares of the insert are, and how they wear, in eights of node_blocks.

use super::{clearance::GAP_PER_MOTION, shares::ShareBlock};
use crate::{
    Vec3, Vector,
    number::vector::dot,
    number::{F32x8, F64x4, LANES, LANES_F32, Number},
};

/// Eight node_blocks: what a clearance from a femur changes with, as that moves.
pub(super) struct Ground {
    /// The means of the four centres, mm.
    pub middles: Vector<F32x8>,
    /// How much nearer a turn of the femur brings them beside, mm/rad: by how far a centre is from
    /// the middle, and the half edges.
    pub levers_mm: F32x8,
}

/// How eight node_blocks have worn.
pub(super) struct Wear {
    /// Motion of their middles, mm.
    pub moved: Vector<F32x8>,
    /// Loss of clearance beside, mm.
    pub lost_mm: F32x8,
}

/// How all have worn last.
pub(super) struct LastWear {
    /// How often they have worn.
    pub number: u32,
    pub eights: Vec<Wear>,
}

impl Ground {
    /// All shares of a surface.
    pub fn of(shares: &[ShareBlock]) -> Vec<Self> {
        shares.chunks(LANES_F32).map(Self::new).collect()
    }

    fn new(node_blocks: &[ShareBlock]) -> Self {
        let at = |i: usize| &node_blocks[i.min(node_blocks.len() - 1)];
        let axis = |axis: usize| F32x8::from_lanes(|i| middle(at(i))[axis]);
        Self {
            middles: Vector::new(axis(0), axis(1), axis(2)),
            levers_mm: F32x8::from_lanes(|i| lever_mm(at(i))),
        }
    }
}

impl Wear {
    /// All shares of a surface, from those before.
    pub fn between(before: &[ShareBlock], after: &[ShareBlock]) -> Vec<Self> {
        let eights = before.chunks(LANES_F32).zip(after.chunks(LANES_F32));
        eights
            .map(|(before, after)| Self::new(before, after))
            .collect()
    }

    fn new(before: &[ShareBlock], after: &[ShareBlock]) -> Self {
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
        let axis = |axis: usize| F32x8::from_lanes(|i| moved(i)[axis]);
        Self {
            moved: Vector::new(axis(0), axis(1), axis(2)),
            lost_mm: F32x8::from_lanes(lost_mm),
        }
    }
}

fn middle(four: &ShareBlock) -> Vec3 {
    four.centre.map(|lanes| lanes.sum() / LANES as f64)
}

fn lever_mm(four: &ShareBlock) -> f64 {
    four.half_mm + GAP_PER_MOTION * longest_mm(&(four.centre - middle(four).map(F64x4::splat)))
}

/// What wear of four shares whose middle moves by `moved` may take from their clearance beside, mm.
///
/// Each centre may move otherwise than the middle. The reach changes by no more than half of what
/// the edges do; a fifth of that is more than what the mean over the share does, and longer edges
/// through a turn of the normal.
fn lost_mm(before: &ShareBlock, after: &ShareBlock, moved: &Vec3) -> f64 {
    let astray = after.centre - before.centre - moved.map(F64x4::splat);
    let [by_a, by_b] = [after.edge_a - before.edge_a, after.edge_b - before.edge_b];
    GAP_PER_MOTION * longest_mm(&astray) + 0.6 * (longest_mm(&by_a) + longest_mm(&by_b))
}

fn longest_mm(vectors: &Vector<F64x4>) -> f64 {
    dot(vectors, vectors).greatest().sqrt()
}
