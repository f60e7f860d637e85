//! The compiled part of the Python package `condyle`: cases and runs, with arrays in and out.
//!
//! The public interface is in `python/condyle`, the only caller; `_condyle.pyi` has the types.

#![expect(
    clippy::needless_pass_by_value,
    reason = "a function called from Python owns what it is given"
)]

mod case;
mod errors;
mod folder;
mod knee;
mod law;
mod listener;
mod record;
mod run;
mod study;

use pyo3::prelude::*;

/// The compiled part of condyle; use the package `condyle`.
#[pymodule]
mod _condyle {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::case::{RawCase, toml_document, toml_value, with_table};
    #[pymodule_export]
    use super::folder::read_folder;
    #[pymodule_export]
    use super::knee::RawKnee;
    #[pymodule_export]
    use super::run::run;
    #[pymodule_export]
    use super::study::{RawHeldStudy, RawStudy};

    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        // An ImportError, before the first such instruction would end the interpreter.
        if condyle_lab::is_processor_supported() {
            return Ok(());
        }
        Err(pyo3::exceptions::PyImportError::new_err(
            "this condyle was built for x86 processors with AVX2 and FMA, and this one lacks them; install it with \
                RUSTFLAGS=\"-C target-cpu=x86-64\" pip install ./python, and it runs at about half the speed",
        ))
    }

    /// Returns the unit that the name of a quantity ends in; empty for a pure number.
    #[pyfunction]
    fn unit_of(name: &str) -> &'static str {
        match name {
            "percent" => "%",
            name => condyle_results::split_unit(name).1.unwrap_or_default(),
        }
    }

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
