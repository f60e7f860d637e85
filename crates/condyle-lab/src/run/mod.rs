//! Runs of a case into a results folder, from the start or from a checkpoint; or into memory.

pub(crate) mod error;
pub(crate) mod folder;
pub(crate) mod prepare;
pub(crate) mod running;

use std::{
    ops::ControlFlow,
    path::PathBuf,
    time::{Duration, Instant},
};

use condyle::evolve::{March, Progress, UpdateRecord};
use condyle_case::cache::Cache;
use condyle_results::Summary;
use serde::Serialize;

/// Receives every event, and may stop the run by breaking.
pub(crate) type Listener<'a> = dyn FnMut(RunEvent<'_>) -> ControlFlow<()> + 'a;

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Reached {
    /// Updates done.
    pub updates: usize,
    /// Cycles done.
    pub cycles: f64,
    /// Cycles in all.
    pub of_cycles: f64,
}

impl Reached {
    pub(crate) fn by(march: &March) -> Self {
        Self {
            updates: march.state().updates.len(),
            cycles: march.cycles(),
            of_cycles: march.test().schedule.cycles,
        }
    }
}

/// An event while a case runs.
#[derive(Clone, Debug)]
pub enum RunEvent<'a> {
    /// A correction of the input, or a remark on suspicious input.
    Warning(String),
    /// The bodies are placed, and the folder of a new run is not created yet.
    Placed,
    /// The folder is ready, or the checkpoint is read.
    Started(Reached),
    /// An increment is solved.
    Solved(Progress),
    /// All updates are done, and an increment is solved to estimate their errors.
    Estimating,
    /// An update is done and stored.
    Updated(&'a UpdateRecord),
}

/// The end of a run.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// All cycles are done.
    Done(Box<Summary>),
    /// The folder already holds the whole run; nothing was computed.
    DoneBefore(Box<Summary>),
    /// The user stopped the run; its updates are stored, and it can be resumed.
    Interrupted(Reached),
}

/// Options of a run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder for the results.
    pub out: PathBuf,
    /// Resume the run in the folder.
    pub resume: bool,
    /// Replace the run in the folder.
    pub force: bool,
    /// Threads for the one-time work on a mesh; results do not depend on it.
    pub threads: usize,
    /// The cache of the one-time work on a mesh for the next run; results do not depend on it.
    pub cache: Cache,
    /// Write the report page, too; [`condyle_report::write_report`] writes it later.
    pub report: bool,
}

/// Time spent on the solver alone.
#[derive(Default)]
pub(crate) struct Clock {
    pub spent: Duration,
}

impl Clock {
    /// Does some work, and adds its time.
    pub fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.spent += start.elapsed();
        result
    }
}
