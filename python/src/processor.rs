//! What this build asks of the processor, said before an instruction that it lacks ends the interpreter.

use pyo3::prelude::*;

/// An ImportError where this machine's processor lacks what the build asks for.
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

/// Nothing is asked of other processors.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
pub fn check() -> PyResult<()> {
    Ok(())
}
