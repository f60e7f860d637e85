//! Runs of cases, and studies over them.

mod run;

pub use run::{Happening, Outcome, RunError, RunOptions, check, run};
