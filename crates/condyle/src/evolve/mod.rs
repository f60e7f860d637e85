//! From depth to new shape: the march over millions of cycles.
//!
//! | file | what |
//! | --- | --- |
//! | `wear_test` | a whole test: bodies, laws, activities, schedule |
//! | `placement` | the femur is lowered onto the insert, and settles |
//! | `march` | the loop over updates: cycles solved, rates, a step, the new surface |
//! | `rates` | what a cycle wears, and how soon wear changes that |
//! | `comparison_laws` | what the other laws would have worn by the same cycles |
//! | `activity_wear` | what each of several activities wears |
//! | `step`, `interval` | the next step: how long it is, and by which rule it wears |
//! | `extrapolated_step`, `exponential_step` | the rules |
//! | `accumulated_error` | what the length of the steps costs in accuracy |
//! | `depth` | how deep the surface has gone down, by what, and what of it is mass lost |
//! | `creep`, `creep_contact`, `creep_record` | how far creep takes the surface down, by what load, and what is told of it |
//! | `records`, `node_fields`, `state`, `solved_cycle` | what is told, and what is remembered |

mod accumulated_error;
mod activity_wear;
mod comparison_laws;
mod creep;
mod creep_contact;
mod creep_record;
mod depth;
mod exponential_step;
mod extrapolated_step;
mod interval;
mod march;
mod march_error;
mod mean_over_wear;
mod node_fields;
mod placement;
mod placement_error;
mod rates;
mod records;
mod schedule;
mod solved_cycle;
mod state;
mod step;
mod step_record;
mod under_surface_record;
mod wear_test;

pub use accumulated_error::AccumulatedError;
pub use activity_wear::ActivityWear;
pub use comparison_laws::LawBeside;
pub use creep::CreepState;
pub use creep_record::CreepRecord;
pub use depth::{DepthField, DepthFields};
pub use march::March;
pub use march_error::{MarchError, WornAndCrept};
pub use mean_over_wear::{mean_over_volume, weight_of_depth};
pub use node_fields::NodeFields;
pub use placement_error::PlacementError;
pub use records::{CycleRecord, Progress, UpdateRecord};
pub use schedule::{Schedule, Updates};
pub use solved_cycle::SolvedCycle;
pub use state::{ActivityState, MarchState, SNAPSHOT_PARTS, Snapshot};
pub use step_record::StepRecord;
pub use under_surface_record::{PlasticRecord, UnderSurfaceRecord};
pub use wear_test::{Activity, WearTest};
