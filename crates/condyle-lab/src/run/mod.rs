//! A case run into a results folder, from the start or from where it was stopped.

mod bridged;
mod clock;
mod error;
mod event;
mod memory;
mod options;
mod prepare;
mod run_case;

pub(crate) use clock::Clock;
pub use error::RunError;
pub use event::{Outcome, Reached, RunEvent};
pub(crate) use memory::memory_mb;
pub use options::RunOptions;
pub(crate) use prepare::{build, changed, start};
pub use prepare::{check, check_changed};
pub use run_case::{run, run_case, run_changed};
