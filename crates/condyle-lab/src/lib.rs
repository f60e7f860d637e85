//! Runs of cases, and studies over them.

mod accuracy;
mod at_rest;
mod markdown;
pub mod measured;
mod plausibility;
pub mod pressure_law;
mod preview;
mod run;

pub use crate::{
    at_rest::AtRest,
    markdown::aligned,
    preview::{Expected, FemurFacts, InsertFacts, Preview},
    run::{
        Outcome, Reached, RunEvent, RunOptions,
        error::RunError,
        folder::{run, run_case, run_changed},
        prepare::{check, check_changed, settled},
        running::{InMemory, RunKeeper, batch_run, run_in_memory},
    },
};
