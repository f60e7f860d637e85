//! How far every block is from touching, carried along as the femur moves.

use super::{
    block_places::{BlockPlaces, LastWear},
    separation_bound::SeparationBound,
};
use crate::{
    Mat3, Vec3, Vector,
    number::vector::dot,
    number::{F32x8, LANES_F32, Number},
    spatial::Pose,
};

/// More than is rounded off in a step, mm.
const ROUNDED_OFF_MM: f64 = 2e-6;

/// A larger separation counts as this much, mm: single precision then rounds less off than
/// [`ROUNDED_OFF_MM`].
const FARTHEST_MM: f64 = 16.0;

/// Eight numbers as they lie in memory.
type Numbers = [f32; LANES_F32];

/// How far every block is from touching where the femur is.
#[derive(Clone)]
pub(super) struct Separations {
    at: Option<Pose>,
    eights: Vec<Eight>,
    count: usize,
    /// How often the blocks had worn.
    worn: u32,
}

/// The [bounds](SeparationBound) of eight blocks.
#[derive(Clone)]
struct Eight {
    clear_mm: Numbers,
    slope: [Numbers; 3],
    loss: Numbers,
    radius_mm: Numbers,
}

/// How points of the insert move in the femoral frame from one pose to another.
struct FemurStep {
    /// Change of a place by its coordinates x, y and z.
    turn: [Vector<F32x8>; 3],
    shift: Vector<F32x8>,
    turn_rad: F32x8,
}

/// What was known where the femur was at another increment, and the way from there.
struct Neighbour<'a> {
    eights: &'a [Eight],
    step: FemurStep,
}

impl Neighbour<'_> {
    /// Gives eight blocks the bounds of those that may touch by theirs, and are apart by its own; a bit for
    /// each that still may touch.
    #[inline(always)]
    fn help(&self, number: usize, places: &BlockPlaces, bounds: &mut Eight, may_touch: u32) -> u32 {
        let mut known = self.eights[number].clone();
        let motion = self.step.of(&places.middles);
        let apart = may_touch & !known.carry(&motion, self.step.lost_mm(places));
        bounds.take_over(apart, &known);
        may_touch & !apart
    }
}

impl FemurStep {
    fn between(from: &Pose, to: &Pose) -> Self {
        let turn: Mat3 = (to.rotation - from.rotation).transpose();
        let shift = to.to_femur(&Vec3::zeros()) - from.to_femur(&Vec3::zeros());
        Self {
            turn: columns(&turn),
            shift: shift.map(F32x8::splat),
            turn_rad: F32x8::splat(turn.norm()),
        }
    }

    /// What eight blocks may lose besides their motion, mm.
    #[inline(always)]
    fn lost_mm(&self, places: &BlockPlaces) -> F32x8 {
        let rounded_off_mm = F32x8::splat(ROUNDED_OFF_MM);
        places.levers_mm.mul_add(self.turn_rad, rounded_off_mm)
    }

    /// The motion of places.
    #[inline(always)]
    fn of(&self, place: &Vector<F32x8>) -> Vector<F32x8> {
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
    /// Of blocks that touch.
    const TOUCHING: Self = Self {
        clear_mm: [f32::NEG_INFINITY; LANES_F32],
        slope: [[0.0; LANES_F32]; 3],
        loss: [0.0; LANES_F32],
        radius_mm: [f32::INFINITY; LANES_F32],
    };

    /// Carries the bounds along a motion of the blocks' middles in the femoral frame that may bring them
    /// nearer by `lost_mm` besides; a bit for each block that may touch after it.
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

    /// Takes over those bounds of others that have a bit.
    fn take_over(&mut self, mut which: u32, others: &Self) {
        while which != 0 {
            let i = which.trailing_zeros() as usize;
            self.clear_mm[i] = others.clear_mm[i];
            for axis in 0..3 {
                self.slope[axis][i] = others.slope[axis][i];
            }
            self.loss[i] = others.loss[i];
            self.radius_mm[i] = others.radius_mm[i];
            which &= which - 1;
        }
    }
}

impl Separations {
    /// All of `count` blocks may touch, however often they have worn.
    pub fn new(count: usize) -> Self {
        Self {
            at: None,
            eights: vec![Eight::TOUCHING; count.div_ceil(LANES_F32)],
            count,
            worn: 0,
        }
    }

    /// How often the blocks had worn.
    pub fn worn(&self) -> u32 {
        self.worn
    }

    /// The femur moves on, and the blocks have worn to `places` if they had not yet; lists the blocks
    /// that may touch now, ascending.
    ///
    /// Blocks that another increment knows to be apart, from where the femur was then, take over its bounds,
    /// if it is of the blocks as they have worn.
    pub fn follow(
        &mut self,
        to: &Pose,
        places: &[BlockPlaces],
        last: &LastWear,
        other: Option<&Self>,
        candidates: &mut Vec<u32>,
    ) {
        let neighbour = other.and_then(|other| other.neighbour(to, last));
        let from = self.at.replace(*to).unwrap_or(*to);
        let step = FemurStep::between(&from, to);
        let axes = columns(&from.rotation);
        let wear = (self.worn < last.number).then_some(&last.eights);
        self.worn = last.number;
        candidates.clear();
        for (number, (bounds, places)) in self.eights.iter_mut().zip(places).enumerate() {
            let mut lost_mm = step.lost_mm(places);
            let mut motion = step.of(&places.middles);
            if let Some(wear) = wear.map(|wear| &wear[number]) {
                motion += wear.seen_along(&axes);
                lost_mm += wear.lost_mm;
            }
            let mut may_touch = bounds.carry(&motion, lost_mm);
            if let Some(neighbour) = &neighbour
                && may_touch != 0
            {
                may_touch = neighbour.help(number, places, bounds, may_touch);
            }
            while may_touch != 0 {
                candidates.push((number * LANES_F32) as u32 + may_touch.trailing_zeros());
                may_touch &= may_touch - 1;
            }
        }
        // The last eight may not be full.
        candidates.truncate(candidates.partition_point(|&block| (block as usize) < self.count));
    }

    /// What this knows where the femur is to go, if it is of the blocks as they have worn last.
    fn neighbour(&self, to: &Pose, last: &LastWear) -> Option<Neighbour<'_>> {
        let at = self.at.as_ref().filter(|_| self.worn == last.number)?;
        Some(Neighbour {
            eights: &self.eights,
            step: FemurStep::between(at, to),
        })
    }

    /// A block was sampled where the femur is now, and is apart.
    #[inline(always)]
    pub fn set(&mut self, block: u32, bound: &SeparationBound) {
        let (eight, i) = self.place_of(block);
        eight.clear_mm[i] = bound.clear_mm.min(FARTHEST_MM) as f32;
        eight.slope[0][i] = bound.slope.x as f32;
        eight.slope[1][i] = bound.slope.y as f32;
        eight.slope[2][i] = bound.slope.z as f32;
        eight.loss[i] = bound.loss as f32;
        eight.radius_mm[i] = bound.radius_mm as f32;
    }

    /// A block touches: it may go on touching wherever the femur moves.
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
