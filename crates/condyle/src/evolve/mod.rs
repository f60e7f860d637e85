//! From depth to new shape: the march over millions of cycles.

mod interval;
mod march;
mod march_error;
mod placement;
mod rates;
mod records;
mod relaxing;
mod schedule;
mod state;
mod step;
mod step_error;
mod wear_test;

pub use march::March;
pub use march_error::MarchError;
pub use placement::PlacementError;
pub use records::{CycleRecord, NodeFields, Progress, UpdateRecord};
pub use schedule::{Schedule, Updates};
pub use state::{MarchState, SNAPSHOT_PARTS, Snapshot};
pub use step::StepRecord;
pub use step_error::StepError;
pub use wear_test::WearTest;
