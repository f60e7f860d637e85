//! The blocks of shares near the counterface, each with its sample of it.

use crate::{
    Vector,
    contact::{
        broad_phase::{BroadPhase, SeparationBound, ShareBlock},
        law::ContactSettings,
    },
    geometry::{Counterface, SurfaceSample},
    number::{F64x4, Number, dot},
    spatial::{Pose, Pose4},
};

pub(crate) struct NearBlock {
    pub block: u32,
    pub cached: CachedSample,
}

/// The search state that one contact leaves to the next one; it speeds that up and changes none of its results.
pub(crate) struct NearCache {
    blocks: Vec<ShareBlock>,
    broad_phase: BroadPhase,
}

/// Finds the blocks of shares within reach of the counterface.
///
/// Invariant: the result depends on the pose alone, except for extrapolated samples.
pub(crate) struct NearBlocks<'a> {
    counterface: &'a Counterface,
    pub blocks: Vec<ShareBlock>,
    pub broad_phase: BroadPhase,
    /// Motion up to which a sample is extrapolated, mm.
    reuse_mm: f64,
    /// The last sample of the counterface under every block, and the number of the last search at which the block was near.
    cached: Vec<CachedSample>,
    near_at: Vec<u64>,
    /// The number of the last search: the first is 2, and no block was near at the one before it.
    number: u64,
    /// The blocks that may be near, and the places of their centres in the counterface frame.
    candidates: Vec<(u32, Vector<F64x4>)>,
}

impl<'a> NearBlocks<'a> {
    /// Prepares the search among `blocks`; faster with the cache of a contact of the same insert, less worn, under the
    /// same counterface.
    pub fn new(
        cache: Option<NearCache>,
        counterface: &'a Counterface,
        blocks: Vec<ShareBlock>,
        settings: ContactSettings,
    ) -> Self {
        Self {
            counterface,
            broad_phase: match cache {
                Some(cache) if cache.broad_phase.search == settings.search => {
                    cache.broad_phase.worn(&cache.blocks, &blocks)
                }
                Some(_) | None => BroadPhase::new(settings.search, &blocks),
            },
            reuse_mm: settings.sample_reuse_mm,
            cached: vec![CachedSample::nothing(); blocks.len()],
            near_at: vec![0; blocks.len()],
            number: 1,
            blocks,
            candidates: Vec::new(),
        }
    }

    pub fn into_cache(self) -> NearCache {
        NearCache {
            blocks: self.blocks,
            broad_phase: self.broad_phase,
        }
    }

    /// Passes to `found` every block with a share whose gap is within its reach, in ascending order.
    ///
    /// `reach` returns the reach of the shares, mm, and further numbers of the block to be passed on.
    pub fn find<K>(
        &mut self,
        pose: &Pose,
        pose4: &Pose4,
        reach: impl Fn(&CachedSample, &ShareBlock) -> (F64x4, K),
        mut found: impl FnMut(NearBlock, K),
    ) {
        // Two short loops run faster than one long loop in which every step waits for the one before.
        self.candidates.clear();
        for &block in self.broad_phase.candidates(pose) {
            let centre = &self.blocks[block as usize].centre;
            self.candidates.push((block, pose4.to_counterface(centre)));
        }
        let counterface = self.counterface;
        self.number += 1;
        for &(block, place) in &self.candidates {
            let at = block as usize;
            let shares = &self.blocks[at];
            let was_near = self.near_at[at] + 1 == self.number;
            let last = &self.cached[at];
            let motion = place - last.place;
            let reuses =
                was_near && dot(&motion, &motion).greatest() <= self.reuse_mm * self.reuse_mm;
            let cached = if reuses {
                // To second order, with the curvature of the sample.
                let sample = last.sample.moved(&motion);
                CachedSample { place, sample }
            } else {
                CachedSample::at(counterface, place, shares.spread_mm2)
            };
            let (reach_mm, known) = reach(&cached, shares);
            if (cached.sample.gap_mm - reach_mm).least() > 0.0 {
                self.broad_phase.is_apart(block, || {
                    let curvature = counterface.curvature_bounds(&place);
                    SeparationBound::new(&cached.sample, reach_mm, shares, curvature)
                });
            } else {
                self.broad_phase.touches(block);
                // Samples are kept only while a block is near: they then depend on the motion and not on the
                // candidates of the broad phase.
                self.near_at[at] = self.number;
                if !reuses {
                    self.cached[at] = cached;
                }
                found(NearBlock { block, cached }, known);
            }
        }
    }
}

/// A sample of the counterface under a block of shares.
#[derive(Clone, Copy)]
pub(crate) struct CachedSample {
    /// Places of the shares' centres in the counterface frame, p, mm.
    pub place: Vector<F64x4>,
    pub sample: SurfaceSample<F64x4>,
}

impl CachedSample {
    /// Returns a placeholder for a missing sample, farther away than any motion.
    pub fn nothing() -> Self {
        Self {
            place: Vector::repeat(F64x4::splat(f64::INFINITY)),
            sample: SurfaceSample::far(),
        }
    }

    #[inline(always)]
    pub fn at(counterface: &Counterface, place: Vector<F64x4>, spread_mm2: F64x4) -> Self {
        let sample = counterface.sample(&place, spread_mm2);
        Self { place, sample }
    }
}
