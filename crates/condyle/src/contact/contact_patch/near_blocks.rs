//! The blocks of shares that the femur comes near, each with its sample of it.

use crate::{
    Vector,
    contact::{
        broad_phase::{BroadPhase, SeparationBound},
        share_block::ShareBlock,
    },
    geometry::{FemoralSurface, SurfaceSample},
    number::{F64x4, Number, dot},
    spatial::{Pose, Pose4},
};

/// A block of shares that the femur comes near.
pub(crate) struct NearBlock {
    /// Number of the block.
    pub block: u32,
    pub cached: CachedSample,
}

/// The search state that one contact leaves to the next one, which it makes quicker.
pub(crate) struct NearCache<B> {
    blocks: Vec<ShareBlock>,
    search: B,
}

/// Finds the blocks of shares within reach of the femur, by a broad phase `B`.
///
/// Invariant: the result depends on the pose alone, but for samples that are extrapolated.
pub(crate) struct NearBlocks<'a, B> {
    femur: &'a FemoralSurface,
    pub blocks: Vec<ShareBlock>,
    search: B,
    /// Motion up to which a sample is extrapolated, mm.
    reuse_mm: f64,
    /// Every block's last sample of the femur, and the number of the search at which it was near last.
    cached: Vec<CachedSample>,
    near_at: Vec<u64>,
    /// The number of the last search: the first is 2, and none was near at the one before it.
    number: u64,
    /// The blocks that may be near, and the places of their centres in the femoral frame.
    candidates: Vec<(u32, Vector<F64x4>)>,
}

impl<'a, B: BroadPhase> NearBlocks<'a, B> {
    /// The blocks of an insert, found quicker where another left its cache for the insert less worn, under
    /// the same femur.
    pub fn after(
        cache: Option<NearCache<B>>,
        femur: &'a FemoralSurface,
        blocks: Vec<ShareBlock>,
        reuse_mm: f64,
    ) -> Self {
        Self {
            femur,
            search: match cache {
                Some(cache) => cache.search.worn(&cache.blocks, &blocks),
                None => B::new(&blocks),
            },
            reuse_mm,
            cached: vec![CachedSample::nothing(); blocks.len()],
            near_at: vec![0; blocks.len()],
            number: 1,
            blocks,
            candidates: Vec::new(),
        }
    }

    /// See [`BroadPhase::begin_increment`].
    pub fn begin_increment(&mut self, increment: usize) {
        self.search.begin_increment(increment);
    }

    /// Returns the search state for the next contact.
    pub fn into_cache(self) -> NearCache<B> {
        let (blocks, search) = (self.blocks, self.search);
        NearCache { blocks, search }
    }

    /// Tells `found` of every block with a share whose gap is within its reach, in ascending order.
    ///
    /// `reach` says how far that is, mm, and what else it knows of the block.
    pub fn find<K>(
        &mut self,
        pose: &Pose,
        pose4: &Pose4,
        reach: impl Fn(&CachedSample, &ShareBlock) -> (F64x4, K),
        found: impl FnMut(NearBlock, K),
    ) {
        self.find_candidates(pose, pose4);
        self.sample_candidates(reach, found);
    }

    /// Lists the blocks that may be near.
    ///
    /// They are found first and sampled after: the processor goes through two short loops faster than
    /// through a long one, where every step waits for the one before.
    fn find_candidates(&mut self, pose: &Pose, pose4: &Pose4) {
        self.candidates.clear();
        for &block in self.search.candidates(pose) {
            let centre = &self.blocks[block as usize].centre;
            self.candidates.push((block, pose4.to_femur(centre)));
        }
    }

    /// Samples the femur under every candidate, and tells of those that are near.
    ///
    /// Only what is near is remembered, and until it parts: what is remembered then follows from the
    /// motion alone, and not from what the search named.
    fn sample_candidates<K>(
        &mut self,
        reach: impl Fn(&CachedSample, &ShareBlock) -> (F64x4, K),
        mut found: impl FnMut(NearBlock, K),
    ) {
        let femur = self.femur;
        self.number += 1;
        for &(block, place) in &self.candidates {
            let at = block as usize;
            let shares = &self.blocks[at];
            let was_near = self.near_at[at] + 1 == self.number;
            let reuses = was_near && self.cached[at].reaches(&place, self.reuse_mm);
            let cached = if reuses {
                self.cached[at].extrapolated(place)
            } else {
                CachedSample::at(femur, place, shares.spread_mm2)
            };
            let (reach_mm, known) = reach(&cached, shares);
            if (cached.sample.gap_mm - reach_mm).least() > 0.0 {
                self.search.is_apart(block, || {
                    let curvature = femur.curvature_bounds(&place);
                    SeparationBound::new(&cached.sample, reach_mm, shares, curvature)
                });
            } else {
                self.search.touches(block);
                self.near_at[at] = self.number;
                if !reuses {
                    self.cached[at] = cached;
                }
                found(NearBlock { block, cached }, known);
            }
        }
    }
}

/// A sample of the femur under a block of shares, and the places in its frame where it was taken.
#[derive(Clone, Copy)]
pub(crate) struct CachedSample {
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

    /// A sample recomputed at `place`.
    #[inline(always)]
    pub fn at(femur: &FemoralSurface, place: Vector<F64x4>, spread_mm2: F64x4) -> Self {
        let sample = femur.sample(&place, spread_mm2);
        Self { place, sample }
    }

    /// Returns whether `place` is near enough for the sample to be extrapolated there.
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
