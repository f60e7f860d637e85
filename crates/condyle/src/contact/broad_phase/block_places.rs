//! Where blocks of shares are, and how they wear, eight side by side.

use crate::{
    Vec3, Vector,
    contact::share_block::ShareBlock,
    geometry::MAX_GAP_SLOPE,
    number::vector::dot,
    number::{F32x8, F64x4, LANES, LANES_F32, Number},
};

/// Eight blocks: where they are, as far as a separation from the femur changes with its motion.
pub(super) struct BlockPlaces {
    /// The means of each block's four centres, mm.
    pub middles: Vector<F32x8>,
    /// How much nearer a turn of the femur brings a block besides, mm/rad: the distance of a centre
    /// from the middle, and the half edges.
    pub levers_mm: F32x8,
}

/// How eight blocks have worn.
pub(super) struct BlockWear {
    /// Motion of their middles, mm.
    pub moved: Vector<F32x8>,
    /// Loss of separation besides, mm.
    pub lost_mm: F32x8,
}

/// How all blocks have worn last.
#[derive(Default)]
pub(super) struct LastWear {
    /// How often they have worn.
    pub number: u32,
    /// The last time, eight blocks at a time.
    pub eights: Vec<BlockWear>,
}

impl BlockPlaces {
    /// All blocks of a surface.
    pub fn of(blocks: &[ShareBlock]) -> Vec<Self> {
        blocks.chunks(LANES_F32).map(Self::new).collect()
    }

    fn new(blocks: &[ShareBlock]) -> Self {
        let at = |i: usize| &blocks[i.min(blocks.len() - 1)];
        let axis = |axis: usize| F32x8::from_lanes(|i| middle(at(i))[axis]);
        Self {
            middles: Vector::new(axis(0), axis(1), axis(2)),
            levers_mm: F32x8::from_lanes(|i| lever_mm(at(i))),
        }
    }
}

impl BlockWear {
    /// The motion along three axes.
    #[inline(always)]
    pub fn seen_along(&self, [x, y, z]: &[Vector<F32x8>; 3]) -> Vector<F32x8> {
        let moved = &self.moved;
        Vector::new(dot(x, moved), dot(y, moved), dot(z, moved))
    }

    /// All blocks of a surface, from those before.
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

fn middle(block: &ShareBlock) -> Vec3 {
    block.centre.map(|lanes| lanes.sum() / LANES as f64)
}

fn lever_mm(block: &ShareBlock) -> f64 {
    let from_middle = block.centre - middle(block).map(F64x4::splat);
    block.half_mm + MAX_GAP_SLOPE * longest_mm(&from_middle)
}

/// What wear of a block whose middle moves by `moved` may take from its separation besides, mm.
///
/// Each centre may move otherwise than the middle. The reach of a share changes by no more than half
/// of what its edges do. A fifth of that again is more than the mean over the share changes, and than
/// longer edges gain through a turn of the normal.
fn lost_mm(before: &ShareBlock, after: &ShareBlock, moved: &Vec3) -> f64 {
    let astray = after.centre - before.centre - moved.map(F64x4::splat);
    let [by_a, by_b] = [after.edge_a - before.edge_a, after.edge_b - before.edge_b];
    MAX_GAP_SLOPE * longest_mm(&astray) + 0.6 * (longest_mm(&by_a) + longest_mm(&by_b))
}

fn longest_mm(vectors: &Vector<F64x4>) -> f64 {
    dot(vectors, vectors).greatest().sqrt()
}
