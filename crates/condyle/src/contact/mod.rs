//! Contact between femur and insert: one interface, several models.

mod clearance;
mod foundation;
mod ground;
mod history;
mod law;
mod model;
mod nearness;
mod partial;
mod peak;
mod quadratic;
mod seen;
mod shares;
mod standoff;
mod tangent;
mod traction;

pub use foundation::{Former, Foundation, FoundationSettings};
pub use history::{CycleHistory, Moment, NodeHistory};
pub use law::{PressureLaw, PressureTable, PressureTableError, confined_modulus};
pub use model::{
    ContactModel, Landing, Linearization, MOST_REGIONS, Response, Tangent, TouchedNode,
};
