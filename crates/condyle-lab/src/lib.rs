//! Runs of cases, and studies over them.

mod run;
pub mod studies;

pub use run::{Happening, Outcome, RunError, RunOptions, check, run, run_case};
