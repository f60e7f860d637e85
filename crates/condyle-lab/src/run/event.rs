//! What a run tells while it runs, and how it ends.

use std::ops::ControlFlow;

use condyle::evolve::{March, Progress, UpdateRecord};
use condyle_io::results::Summary;

/// Hears of everything that happens, and may stop the run by breaking.
pub(super) type Listener<'a> = dyn FnMut(RunEvent<'_>) -> ControlFlow<()> + 'a;

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Updates done.
    pub updates: usize,
    /// Gait cycles done.
    pub cycles: f64,
    /// Gait cycles in all.
    pub of_cycles: f64,
}

impl Reached {
    pub(super) fn by(march: &March) -> Self {
        Self {
            updates: march.state().updates.len(),
            cycles: march.cycles(),
            of_cycles: march.test().schedule.cycles,
        }
    }
}

/// What happens while a case runs.
#[derive(Clone, Debug)]
pub enum RunEvent<'a> {
    /// Something was put right or looks doubtful.
    Warning(String),
    /// The bodies are placed, or the checkpoint is read.
    Started(Reached),
    /// An increment is solved.
    Solved(Progress),
    /// All updates are done, and an increment is solved to estimate how accurate they are.
    Estimating,
    /// An update is done and kept.
    Updated(&'a UpdateRecord),
}

/// How a run ended.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// All cycles are done.
    Done(Box<Summary>),
    /// The folder holds the whole run already; nothing was computed.
    DoneBefore(Box<Summary>),
    /// Somebody asked to stop; what was computed is kept, and can be gone on with.
    Interrupted(Reached),
}
