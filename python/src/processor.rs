//! The vector instructions that this build needs, checked before the first one would end the interpreter.

use pyo3::prelude::*;

/// Returns an ImportError if the processor lacks AVX2 or FMA.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
#[inline(never)]
pub fn check() -> PyResult<()> {
    let features = raw_cpuid::CpuId::new();
    let has_avx2 = features
        .get_extended_feature_info()
        .is_some_and(|features| features.has_avx2());
    let has_fma = features
        .get_feature_info()
        .is_some_and(|features| features.has_fma());
    if has_avx2 && has_fma {
        return Ok(());
    }
    Err(pyo3::exceptions::PyImportError::new_err(
        "this condyle was built for x86 processors with AVX2 and FMA, and this one lacks them; install it with \
         RUSTFLAGS=\"-C target-cpu=x86-64\" pip install ./python, and it runs at about half the speed",
    ))
}

/// Builds for other processors need nothing.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
pub fn check() -> PyResult<()> {
    Ok(())
}
