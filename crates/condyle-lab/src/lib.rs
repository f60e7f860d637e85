//! Runs of cases, and studies over them.

mod accuracy;
mod at_rest;
mod markdown;
pub mod measured;
mod plausibility;
pub mod pressure_law;
mod preview;
mod run;

pub use crate::{
    at_rest::AtRest,
    markdown::aligned,
    preview::{BodyFacts, EdgeFacts, Expected, InsertFacts, Preview},
    run::{
        Outcome, Reached, RunEvent, RunOptions,
        error::RunError,
        folder::{run, run_case},
        prepare::settled,
        running::{InMemory, RunKeeper, batch_run, run_in_memory},
    },
};

/// Returns true if the processor has the vector instructions of the build, on x86 AVX2 and FMA.
///
/// A program that starts without this check ends at its first vector with "illegal instruction". The check of the
/// standard library answers from the build, not from the processor.
// Not inlined, so that no vector instruction of the caller moves before it.
#[inline(never)]
pub fn is_processor_supported() -> bool {
    #[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
    {
        let processor = raw_cpuid::CpuId::new();
        let extended = processor.get_extended_feature_info();
        let features = processor.get_feature_info();
        extended.is_some_and(|one| one.has_avx2()) && features.is_some_and(|one| one.has_fma())
    }
    #[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
    true
}
