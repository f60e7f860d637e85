//! A block's last sample of the femur, and the one approximation that it allows.

use crate::{
    Vector,
    geometry::{FemoralSurface, SurfaceSample},
    number::{F64x4, Number, vector::dot},
};

/// A sample of the femur under a block of shares, and the places in its frame where it was taken.
#[derive(Clone, Copy)]
pub(in crate::contact) struct CachedSample {
    /// Places of the shares' centres, p, mm.
    pub place: Vector<F64x4>,
    pub sample: SurfaceSample<F64x4>,
}

impl CachedSample {
    /// Nothing yet: farther away than any motion.
    pub fn nothing() -> Self {
        Self {
            place: Vector::repeat(F64x4::splat(f64::INFINITY)),
            sample: SurfaceSample::far(),
        }
    }

    /// A sample taken anew at `place`.
    #[inline(always)]
    pub fn at(femur: &FemoralSurface, place: Vector<F64x4>, spread_mm2: F64x4) -> Self {
        let sample = femur.sample(&place, spread_mm2);
        Self { place, sample }
    }

    /// Whether `place` is so near that the sample may be extrapolated there.
    #[inline(always)]
    pub fn reaches(&self, place: &Vector<F64x4>, reuse_mm: f64) -> bool {
        let motion = place - self.place;
        dot(&motion, &motion).greatest() <= reuse_mm * reuse_mm
    }

    /// The sample extrapolated to `place`, to second order.
    #[inline(always)]
    pub fn extrapolated(&self, place: Vector<F64x4>) -> Self {
        let sample = self.sample.moved(&(place - self.place));
        Self { place, sample }
    }
}
