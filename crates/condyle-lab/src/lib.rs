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
    preview::{BodyFacts, Expected, InsertFacts, Preview},
    run::{
        Outcome, Reached, RunEvent, RunOptions,
        error::RunError,
        folder::{run, run_case},
        prepare::settled,
        running::{InMemory, RunKeeper, batch_run, run_in_memory},
    },
};
