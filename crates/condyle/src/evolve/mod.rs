//! From depth to new shape: the march over millions of cycles.
//!
//! | file | content |
//! | --- | --- |
//! | `wear_test` | a whole test: bodies, laws, activities, schedule |
//! | `placement` | lowers the counterface onto the insert and lets it settle |
//! | `march` | the loop over updates: cycles solved, rates, a step, the new surface |
//! | `solved_cycles` | the solution of the cycles of an update |
//! | `rates` | the wear per cycle, the rate at which wear changes it, and a step of the march |
//! | `next_step`, `step_rules` | the interval of a step, the wear over it, and the error that its length causes |
//! | `comparison_laws`, `law_family` | the wear by other laws, by all laws of powers, and by each activity |
//! | `depth` | the depth of the surface by cause |
//! | `creep` | the depth by creep, and the load that causes it |
//! | `records`, `state` | the results of an update, and the state from which a march resumes |

mod comparison_laws;
mod creep;
mod depth;
mod error;
mod law_family;
mod march;
mod next_step;
mod placement;
mod rates;
mod records;
mod solved_cycles;
mod state;
mod step_rules;
mod wear_test;

pub use comparison_laws::{ActivityWear, ComparisonLaw};
pub use creep::CreepState;
pub use depth::Depths;
pub use error::{MarchError, PlacementError};
pub use law_family::FamilyWear;
pub use march::March;
pub use rates::{StepRecord, mean_over_volume, weight_of_depth};
pub use records::{
    CreepRecord, CyclePeaks, CycleRecord, NodeFields, PlasticRecord, Progress, UnderSurfaceRecord,
    UpdateRecord,
};
pub use solved_cycles::SolvedCycle;
pub use state::{ActivityState, MarchState, SNAPSHOT_PARTS, Snapshot};
pub use step_rules::AccumulatedError;
pub use wear_test::{Activity, Schedule, Updates, WearTest};
