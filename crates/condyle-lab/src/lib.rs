//! Runs of cases, and studies over them.

mod accuracy;
mod at_rest;
pub mod measured;
mod plausibility;
mod preview;
mod run;
#[cfg(feature = "studies")]
pub mod studies;

pub use at_rest::AtRest;
pub use preview::{Expected, FemurFacts, InsertFacts, Preview};
pub use run::{
    InMemory, Outcome, Reached, RunError, RunEvent, RunKeeper, RunOptions, check, check_changed,
    run, run_case, run_changed, run_in_memory, settled,
};
