//! Contact between femur and insert: one interface, several laws.
//!
//! | file or folder | what |
//! | --- | --- |
//! | [`ContactModel`] (`model`) | the interface between machine and contact, and the memory that one contact leaves to the next |
//! | [`ContactLaw`] (`law`) | the law of a test, which makes the contact of two bodies, and its further results |
//! | `history` | pressure and slip of every surface node over a cycle, and their work by direction |
//! | `foundation` | the elastic foundation: rigid bodies, and pressure from local overclosure |
//! | `deformable` | the deformable insert: pressure under which an elastic body just touches the femur |
//! | `contact_patch` | the shares under pressure and their sums, common to all laws |
//! | `pressure_law` | pressure from overclosure of an elastic layer |
//! | `broad_phase` | the blocks of nodes that may touch, by brute force or coherently |

mod broad_phase;
mod contact_patch;
mod deformable;
mod foundation;
mod history;
mod law;
mod model;
mod pressure_law;

pub use broad_phase::Search;
pub use deformable::{Backside, Deformable, FrictionModel};
pub use foundation::Foundation;
pub use history::{CycleHistory, Moment, NodeSums, Record, SlipWork};
pub use law::{
    BacksideAtRest, Bodies, ContactLaw, KnownCompliance, PlasticUnderSurface, Regime, UnderSurface,
};
pub use model::{
    ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, Linearization,
    MAX_REGIONS, NotBorne, Response, Settled, StateField, Tangent, TouchedNode,
};
pub use pressure_law::{
    PressureLaw, PressureTable, PressureTableError, confined_modulus, softening_modulus,
};
