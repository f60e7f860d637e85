//! The compiled part of the Python package `condyle`: cases and runs, with arrays in and out.
//!
//! What a user of Python sees is in `python/condyle`; this is called by it alone, and typed in `_condyle.pyi`.

#![expect(
    clippy::needless_pass_by_value,
    reason = "a function called from Python owns what it is given"
)]

mod arrays;
mod case;
mod errors;
mod files;
mod folder;
mod knee;
mod law;
mod listener;
mod processor;
mod record;
mod recorder;
mod run;
mod study;
mod table;

use pyo3::prelude::*;

/// The compiled part of condyle; use the package `condyle`.
#[pymodule]
mod _condyle {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::case::{RawCase, with_table};
    #[pymodule_export]
    use super::folder::read_folder;
    #[pymodule_export]
    use super::knee::RawKnee;
    #[pymodule_export]
    use super::run::{run_in_memory, run_into_folder};
    #[pymodule_export]
    use super::study::{RawHeldStudy, RawStudy};

    /// Done before anything else.
    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::processor::check()
    }

    /// Version of condyle.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
