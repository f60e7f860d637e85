//! Contact between counterface and insert: one interface, several laws.
//!
//! A [`ContactLaw`] belongs to a test and creates a [`ContactModel`] of the bodies as they are now. The machine sees only
//! that.
//!
//! | file or folder | content |
//! | --- | --- |
//! | `model` | the interface [`ContactModel`], and the memory that one contact leaves to the next |
//! | `law` | the interface [`ContactLaw`], and its further results: compliance, state below the surface |
//! | `history` | pressure and slip of every surface node over a cycle, and their work by direction |
//! | `pressure_law` | pressure from overclosure of an elastic layer |
//! | `foundation` | the elastic foundation: rigid bodies, and pressure from local overclosure |
//! | `deformable` | the deformable insert: the pressure under which an elastic body just touches the counterface |
//! | `contact_patch` | the shares under pressure, their tractions and sums, for all laws |
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
    BacksideAtRest, Bodies, ContactLaw, ContactSettings, KnownCompliance, PlasticUnderSurface,
    Regime, UnderSurface,
};
pub use model::{
    ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, MAX_REGIONS, NotBorne,
    Response, Settled, StateField, Tangent, TouchedNode,
};
pub use pressure_law::{
    PressureLaw, PressureTable, PressureTableError, confined_modulus, shell_modulus,
    softening_modulus,
};
