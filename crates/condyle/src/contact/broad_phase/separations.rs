//! Lower bounds on the separation of every block, updated as the counterface moves.

use super::share_block::ShareBlock;
use crate::{
    Mat3, Vec3, Vector,
    geometry::{CurvatureBounds, MAX_GAP_SLOPE, SurfaceSample},
    number::{F32x8, F64x4, LANES, LANES_F32, Number, dot},
    spatial::Pose,
};

/// Upper bound on the rounding error of one step in single precision, mm. Every step subtracts it from the bounds.
const ROUNDED_OFF_MM: f64 = 2e-6;

/// Largest separation that is stored, mm; larger ones are reduced to it. Numbers of this size are rounded in single
/// precision by less than [`ROUNDED_OFF_MM`].
const FARTHEST_MM: f64 = 16.0;

type Numbers = [f32; LANES_F32];

/// Lower bounds on the separation of every block at a pose of the counterface, in single precision, eight blocks at a time.
#[derive(Clone)]
pub(crate) struct Separations {
    at: Option<Pose>,
    eights: Vec<Eight>,
    count: usize,
    /// The number of the change by wear for which the bounds hold.
    pub worn: u32,
}

/// The [bounds](SeparationBound) of eight blocks.
#[derive(Clone)]
struct Eight {
    clear_mm: Numbers,
    slope: [Numbers; 3],
    loss: Numbers,
    radius_mm: Numbers,
}

/// The motion of the insert's points in the counterface frame from one pose to another.
struct CounterfaceStep {
    /// Change of a place by its coordinates x, y and z.
    turn: [Vector<F32x8>; 3],
    shift: Vector<F32x8>,
    turn_rad: F32x8,
}

impl CounterfaceStep {
    fn between(from: &Pose, to: &Pose) -> Self {
        let turn: Mat3 = (to.rotation - from.rotation).transpose();
        let shift = to.to_counterface(&Vec3::zeros()) - from.to_counterface(&Vec3::zeros());
        Self {
            turn: columns(&turn),
            shift: shift.map(F32x8::splat),
            turn_rad: F32x8::splat(turn.norm()),
        }
    }

    /// Returns the loss of separation of eight blocks in addition to the loss by the motion of their middles, mm.
    #[inline(always)]
    fn lost_mm(&self, places: &BlockPlaces) -> F32x8 {
        let rounded_off_mm = F32x8::splat(ROUNDED_OFF_MM);
        places.levers_mm.mul_add(self.turn_rad, rounded_off_mm)
    }

    #[inline(always)]
    fn motion(&self, place: &Vector<F32x8>) -> Vector<F32x8> {
        let [x, y, z] = &self.turn;
        let along = |axis: usize| {
            let across = y[axis].mul_add(place.y, z[axis].mul_add(place.z, self.shift[axis]));
            x[axis].mul_add(place.x, across)
        };
        Vector::new(along(0), along(1), along(2))
    }
}

fn columns(matrix: &Mat3) -> [Vector<F32x8>; 3] {
    [0, 1, 2].map(|axis| Vec3::from(matrix.column(axis)).map(F32x8::splat))
}

impl Eight {
    /// Blocks that touch: they stay candidates wherever the counterface moves.
    const TOUCHING: Self = Self {
        clear_mm: [f32::NEG_INFINITY; LANES_F32],
        slope: [[0.0; LANES_F32]; 3],
        loss: [0.0; LANES_F32],
        radius_mm: [f32::INFINITY; LANES_F32],
    };

    /// Updates the bounds for a motion of the blocks' middles in the counterface frame, which may bring them nearer by a
    /// further `lost_mm`, and returns a bit for each block that may then touch.
    #[inline(always)]
    fn carry(&mut self, motion: &Vector<F32x8>, lost_mm: F32x8) -> u32 {
        // The separation changes by slope . d, and by no more than loss |d| besides. A bound holds within a
        // radius of where its block was sampled, and every step takes its length away from that: a
        // block whose radius is used up is a candidate again.
        let [x, y, z] = self.slope;
        let slope = Vector::new(F32x8::new(x), F32x8::new(y), F32x8::new(z));
        let motion_mm = dot(motion, motion).sqrt() + lost_mm;
        let lost_mm = F32x8::new(self.loss).mul_add(motion_mm, lost_mm);
        let clear_mm = F32x8::new(self.clear_mm) + (dot(&slope, motion) - lost_mm);
        let radius_mm = F32x8::new(self.radius_mm) - motion_mm;
        self.clear_mm = clear_mm.to_array();
        self.radius_mm = radius_mm.to_array();
        clear_mm.not_above_zero() | radius_mm.not_above_zero()
    }
}

impl Separations {
    /// Starts without bounds: all of `count` blocks may touch.
    pub fn new(count: usize) -> Self {
        Self {
            at: None,
            eights: vec![Eight::TOUCHING; count.div_ceil(LANES_F32)],
            count,
            worn: 0,
        }
    }

    /// Carries the bounds to another pose of the counterface and to the last wear, and lists the blocks that may touch then,
    /// ascending.
    ///
    /// If a block may touch by its own bound but is apart by the bound of another increment, it takes the latter,
    /// provided that both hold for the same wear.
    pub fn follow(
        &mut self,
        to: &Pose,
        places: &[BlockPlaces],
        last: &LastWear,
        other: Option<&Self>,
        candidates: &mut Vec<u32>,
    ) {
        let neighbour = other.filter(|other| other.worn == last.number);
        let neighbour = neighbour.and_then(|other| {
            let at = other.at.as_ref()?;
            Some((&other.eights, CounterfaceStep::between(at, to)))
        });
        // Before the first pose there are no bounds to carry, and the step is none.
        let from = self.at.replace(*to).unwrap_or(*to);
        let step = CounterfaceStep::between(&from, to);
        let axes = columns(&from.rotation);
        let wear = (self.worn < last.number).then_some(&last.eights);
        self.worn = last.number;
        candidates.clear();
        for (number, (bounds, places)) in self.eights.iter_mut().zip(places).enumerate() {
            let mut lost_mm = step.lost_mm(places);
            let mut motion = step.motion(&places.middles);
            if let Some(wear) = wear.map(|wear| &wear[number]) {
                motion += wear.seen_along(&axes);
                lost_mm += wear.lost_mm;
            }
            let mut may_touch = bounds.carry(&motion, lost_mm);
            // Most blocks are apart by their own bounds. For the others, a second bound is cheaper than a sample.
            if let Some((eights, step)) = &neighbour
                && may_touch != 0
            {
                let mut known = eights[number].clone();
                let motion = step.motion(&places.middles);
                let mut apart = may_touch & !known.carry(&motion, step.lost_mm(places));
                may_touch &= !apart;
                while apart != 0 {
                    let i = apart.trailing_zeros() as usize;
                    bounds.clear_mm[i] = known.clear_mm[i];
                    for axis in 0..3 {
                        bounds.slope[axis][i] = known.slope[axis][i];
                    }
                    bounds.loss[i] = known.loss[i];
                    bounds.radius_mm[i] = known.radius_mm[i];
                    apart &= apart - 1;
                }
            }
            while may_touch != 0 {
                candidates.push((number * LANES_F32) as u32 + may_touch.trailing_zeros());
                may_touch &= may_touch - 1;
            }
        }
        // The last eight may not be full.
        candidates.truncate(candidates.partition_point(|&block| (block as usize) < self.count));
    }

    /// Sets the bound of a block that was sampled at the present pose and is apart.
    #[inline(always)]
    pub fn set(&mut self, block: u32, bound: &SeparationBound) {
        let (eight, i) = self.place_of(block);
        // Rounding to single precision is covered by the loss that every step subtracts.
        eight.clear_mm[i] = bound.clear_mm.min(FARTHEST_MM) as f32;
        eight.slope[0][i] = bound.slope.x as f32;
        eight.slope[1][i] = bound.slope.y as f32;
        eight.slope[2][i] = bound.slope.z as f32;
        eight.loss[i] = bound.loss as f32;
        eight.radius_mm[i] = bound.radius_mm as f32;
    }

    /// Marks a block as touching: it remains a candidate for any motion of the counterface.
    #[inline(always)]
    pub fn touches(&mut self, block: u32) {
        let (eight, i) = self.place_of(block);
        eight.clear_mm[i] = f32::NEG_INFINITY;
        eight.radius_mm[i] = f32::INFINITY;
    }

    #[inline(always)]
    fn place_of(&mut self, block: u32) -> (&mut Eight, usize) {
        let block = block as usize;
        (&mut self.eights[block / LANES_F32], block % LANES_F32)
    }
}

/// The places of eight blocks, as far as the change of their separation with a motion of the counterface depends on them.
pub(crate) struct BlockPlaces {
    /// The means of each block's four centres, mm.
    pub middles: Vector<F32x8>,
    /// The loss of separation by a turn of the counterface, mm/rad: the distance of a centre from the middle and the half
    /// edges.
    pub levers_mm: F32x8,
}

pub(crate) struct BlockWear {
    /// Motion of their middles, mm.
    pub moved: Vector<F32x8>,
    /// Loss of separation in addition to the loss by that motion, mm.
    pub lost_mm: F32x8,
}

/// The last change of all blocks by wear.
#[derive(Default)]
pub(crate) struct LastWear {
    /// The number of the change, from 1; 0 before the first.
    pub number: u32,
    pub eights: Vec<BlockWear>,
}

impl BlockPlaces {
    pub fn from_blocks(blocks: &[ShareBlock]) -> Vec<Self> {
        blocks.chunks(LANES_F32).map(Self::new).collect()
    }

    fn new(blocks: &[ShareBlock]) -> Self {
        let at = |i: usize| &blocks[i.min(blocks.len() - 1)];
        let axis = |axis: usize| F32x8::from_lanes(|i| middle(at(i))[axis]);
        let lever_mm = |block: &ShareBlock| {
            let from_middle = block.centre - middle(block).map(F64x4::splat);
            block.half_mm + MAX_GAP_SLOPE * longest_mm(&from_middle)
        };
        Self {
            middles: Vector::new(axis(0), axis(1), axis(2)),
            levers_mm: F32x8::from_lanes(|i| lever_mm(at(i))),
        }
    }
}

impl BlockWear {
    /// Returns the motion along three axes.
    #[inline(always)]
    pub fn seen_along(&self, [x, y, z]: &[Vector<F32x8>; 3]) -> Vector<F32x8> {
        let moved = &self.moved;
        Vector::new(dot(x, moved), dot(y, moved), dot(z, moved))
    }

    pub fn between(before: &[ShareBlock], after: &[ShareBlock]) -> Vec<Self> {
        let eights = before.chunks(LANES_F32).zip(after.chunks(LANES_F32));
        eights
            .map(|(before, after)| Self::new(before, after))
            .collect()
    }

    fn new(before: &[ShareBlock], after: &[ShareBlock]) -> Self {
        let changes: [(Vec3, f64); LANES_F32] = std::array::from_fn(|i| {
            let i = i.min(before.len() - 1);
            let moved = middle(&after[i]) - middle(&before[i]);
            (moved, lost_mm(&before[i], &after[i], &moved))
        });
        let axis = |axis: usize| F32x8::from_lanes(|i| changes[i].0[axis]);
        Self {
            moved: Vector::new(axis(0), axis(1), axis(2)),
            lost_mm: F32x8::from_lanes(|i| changes[i].1),
        }
    }
}

fn middle(block: &ShareBlock) -> Vec3 {
    block.centre.map(|lanes| lanes.sum() / LANES as f64)
}

/// Returns the loss of a block's separation by wear in addition to the loss by the motion `moved` of its middle, mm.
///
/// Each centre may move differently from the middle. The reach of a share changes by no more than half of the change
/// of its edges. A fifth of that again covers the change of the mean over the share, and the reach that longer edges
/// gain as the normal turns.
fn lost_mm(before: &ShareBlock, after: &ShareBlock, moved: &Vec3) -> f64 {
    let astray = after.centre - before.centre - moved.map(F64x4::splat);
    let [by_a, by_b] = [after.edge_a - before.edge_a, after.edge_b - before.edge_b];
    MAX_GAP_SLOPE * longest_mm(&astray) + 0.6 * (longest_mm(&by_a) + longest_mm(&by_b))
}

fn longest_mm(vectors: &Vector<F64x4>) -> f64 {
    dot(vectors, vectors).greatest().sqrt()
}

/// Bounds on the curvature hold at least this far around a point, mm.
const HOLDS_MM: f64 = 1.0;

/// Error bound of an extrapolated sample, for gap and reach together, mm.
const EXTRAPOLATED_MM: f64 = 1e-4;

/// A bound on how far a block of shares is from touching, as a function of how the counterface moves on.
///
/// A gap g with gradient G and no second derivative below -h is, a motion d on, at least g + G . d - h d^2/2. The
/// reach of a share, the overclosure that its highest corner has above its middle, grows by its half edges times the
/// turn of the normal: K d on the counterface, and the counterface's own turn. One bound serves all shares of the block: it uses
/// the mean of their gradients, for the motion of their middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeparationBound {
    /// Gap minus reach, minus the largest jump of the mean over a share between two arcs, mm.
    pub clear_mm: f64,
    /// Gradient of the gap by the middle's place in the counterface frame.
    pub slope: Vec3,
    /// The further loss with each millimetre of motion.
    pub loss: f64,
    /// Length of motion up to which the bound holds, mm.
    pub radius_mm: f64,
}

impl SeparationBound {
    /// Creates the bound for shares with a reach of `reach_mm` under a counterface sampled as `sample`, whose gaps are
    /// larger than the reach.
    #[inline(always)]
    pub fn new(
        sample: &SurfaceSample<F64x4>,
        reach_mm: F64x4,
        shares: &ShareBlock,
        curvature: CurvatureBounds,
    ) -> Self {
        let CurvatureBounds {
            radius_mm,
            max_curvature_per_mm,
            concavity_per_mm,
            curvature_jump_per_mm,
        } = curvature;
        let gap_mm = sample.gap_mm;
        let clear_mm = gap_mm - reach_mm - shares.spread_mm2 * F64x4::splat(curvature_jump_per_mm);
        let by_turn = shares.half_mm * max_curvature_per_mm;
        if gap_mm.least() - shares.half_mm > radius_mm {
            // If the curvature of one lane is unknown, the loss of all lanes is bounded by the slopes alone. A lane
            // whose gap is small is known itself, and its own reach counts.
            let known_mm = if radius_mm < 0.0 {
                CurvatureBounds::KNOWN_GAP_MM
            } else {
                0.0
            };
            let is_known = gap_mm - F64x4::splat(known_mm);
            let far_mm = gap_mm - F64x4::splat(shares.half_mm);
            let near_mm = -Number::max(-clear_mm, F64x4::splat(-HOLDS_MM));
            let clear_mm = is_known.below_zero(near_mm, far_mm).least();
            // No gap changes faster than its point moves.
            return Self {
                clear_mm: clear_mm - EXTRAPOLATED_MM,
                slope: Vec3::zeros(),
                loss: MAX_GAP_SLOPE + by_turn,
                radius_mm: f64::INFINITY,
            };
        }
        let gradient = &sample.gap_gradient;
        let slope = gradient.map(|lanes| lanes.sum() / LANES as f64);
        let lean = gradient - slope.map(F64x4::splat);
        let leaning = dot(&lean, &lean).greatest().sqrt();
        Self {
            clear_mm: clear_mm.least() - EXTRAPOLATED_MM,
            slope,
            loss: leaning + by_turn + 0.5 * concavity_per_mm * radius_mm,
            radius_mm,
        }
    }
}
