//! What the page hears while the program works.

use std::io::{self, Write};

use condyle_lab::Reached;
use serde::Serialize;

use crate::failure::Failure;

/// One line on standard output.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Told {
    /// Something was put right or looks doubtful.
    Warning(String),
    /// How far a run has come.
    Reached {
        /// Updates done.
        updates: usize,
        /// Gait cycles done.
        cycles: f64,
        /// Gait cycles in all.
        of_cycles: f64,
    },
    /// All updates are done, and how accurate they are is being estimated.
    Estimating,
    /// What was concluded of a body.
    Remark(String),
    /// It could not be done.
    Failed(Failure),
}

impl From<Reached> for Told {
    fn from(reached: Reached) -> Self {
        let Reached {
            updates,
            cycles,
            of_cycles,
        } = reached;
        Self::Reached {
            updates,
            cycles,
            of_cycles,
        }
    }
}

/// Tells the page; nobody may be listening.
pub fn tell(told: &Told) {
    let line = serde_json::to_string(told).expect("numbers and text always serialise");
    let mut page = io::stdout().lock();
    let _ = writeln!(page, "{line}").and_then(|()| page.flush());
}
