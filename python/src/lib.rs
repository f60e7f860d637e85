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
mod processor;
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
        super::processor::check()
    }

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
