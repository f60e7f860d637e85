//! From depth to new shape: the march over millions of cycles.

mod march;
mod placement;
mod schedule;
mod wear_test;

pub use march::{CycleRecord, March, MarchError, MarchState, NodeFields, Progress, UpdateRecord};
pub use placement::PlacementError;
pub use schedule::Schedule;
pub use wear_test::WearTest;
