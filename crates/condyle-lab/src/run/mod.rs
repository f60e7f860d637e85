//! A case run into a results folder, from the start or from where it was stopped; or into memory.

mod bridged;
mod clock;
mod error;
mod event;
mod in_memory;
mod memory;
#[cfg(feature = "studies")]
mod one_of_many;
mod options;
mod prepare;
mod run_case;
mod running;
mod written;

pub(crate) use clock::Clock;
pub use error::RunError;
pub use event::{Outcome, Reached, RunEvent};
pub use in_memory::{InMemory, RunKeeper, run_in_memory};
pub(crate) use memory::{mean_load_n, memory_mb};
#[cfg(feature = "studies")]
pub(crate) use one_of_many::{march_watched, marched};
pub use options::RunOptions;
pub(crate) use prepare::{build, changed, start};
pub use prepare::{check, check_changed, settled};
pub use run_case::{run, run_case, run_changed};
