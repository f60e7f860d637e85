//! Runs of cases, and studies over them.

pub mod measured;
mod run;
pub mod studies;

pub use run::{Happening, Outcome, RunError, RunOptions, check, run, run_case};
