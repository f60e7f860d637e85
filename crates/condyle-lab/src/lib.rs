//! Runs of cases, and studies over them.

mod accuracy;
pub mod measured;
mod plausibility;
mod run;
pub mod studies;

pub use run::{
    Outcome, Reached, RunError, RunEvent, RunOptions, check, check_changed, run, run_case,
    run_changed,
};
