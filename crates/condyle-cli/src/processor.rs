//! Processor features that this build requires.

use std::process::ExitCode;

/// Returns an error and its exit code if the processor lacks instructions that the build requires.
///
/// Without this look it would stop at the first vector with "illegal instruction". The standard library's
/// own look answers from the build, and not from the processor.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
pub fn check() -> Result<(), ExitCode> {
    let processor = raw_cpuid::CpuId::new();
    let has_avx2 = processor
        .get_extended_feature_info()
        .is_some_and(|features| features.has_avx2());
    let has_fma = processor
        .get_feature_info()
        .is_some_and(|features| features.has_fma());
    if has_avx2 && has_fma {
        return Ok(());
    }
    Err(crate::exit::fail(
        "this condyle was built for x86 processors with AVX2 and FMA, and this one lacks them; build it with \
         RUSTFLAGS=\"-C target-cpu=x86-64\" cargo build --release, and it runs at about half the speed",
        crate::exit::BAD_INPUT,
    ))
}

/// Nothing is asked of other processors.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
pub fn check() -> Result<(), ExitCode> {
    Ok(())
}
