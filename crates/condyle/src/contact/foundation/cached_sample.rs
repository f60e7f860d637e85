//! The femur's side of the contact: what four shares saw of its surface when last sampled.

use crate::{
    Vector,
    geometry::{FemoralSurface, SurfaceSample},
    number::vector::dot,
    number::{F64x4, Number},
};

/// Motion up to which a sample is moved along to second order rather than taken anew, mm.
///
/// Newton's corrections are shorter, so that a mesh's field is looked up once an increment. The
/// second derivatives of a field vary by some 0.003/mm from cell to cell: the gap errs by less than
/// a millionth of a millimetre, and the force by a hundred-thousandth.
pub(super) const MOVED_ALONG_MM: f64 = 0.02;

/// What four shares saw of the femur, and from where in its frame.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    /// Places of the shares' centres, p, mm.
    pub place: Vector<F64x4>,
    pub sample: SurfaceSample<F64x4>,
}

impl Seen {
    /// Nothing yet: farther away than any motion.
    pub fn nothing() -> Self {
        Self {
            place: Vector::repeat(F64x4::splat(f64::INFINITY)),
            sample: SurfaceSample::far(),
        }
    }

    /// The femur as four shares see it at `place`.
    #[inline(always)]
    pub fn anew(femur: &FemoralSurface, place: Vector<F64x4>, spread_mm2: F64x4) -> Self {
        let sample = femur.sample(&place, spread_mm2);
        Self { place, sample }
    }

    /// Whether `place` is so near that what was seen may be moved along there.
    #[inline(always)]
    pub fn reaches(&self, place: &Vector<F64x4>) -> bool {
        let motion = place - self.place;
        dot(&motion, &motion).greatest() <= MOVED_ALONG_MM * MOVED_ALONG_MM
    }

    /// What was seen moved along to `place`.
    #[inline(always)]
    pub fn moved_to(&self, place: Vector<F64x4>) -> Self {
        let sample = self.sample.moved(&(place - self.place));
        Self { place, sample }
    }
}
