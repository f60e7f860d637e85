//! Runs of cases, and studies over them.

mod accuracy;
pub mod measured;
mod run;
pub mod studies;

pub use run::{Happening, Outcome, Reached, RunError, RunOptions, check, run, run_case};
