//! Contact between femur and insert: one interface, several laws.
//!
//! | file or folder | what |
//! | --- | --- |
//! | [`ContactModel`] (`model`) | what the machine asks of a contact, and its answers |
//! | [`ContactLaw`] (`contact_law`) | what a test says of contact: it makes the contact of two bodies |
//! | `memory` | what a contact hands on to the next one: its history, and what makes that quicker |
//! | `history` | what every surface node went through in a cycle |
//! | `slip_work` | pressure times slip by direction: cross-shear and principal direction |
//! | `foundation` | the elastic foundation: rigid bodies, and pressure from local overclosure |
//! | `deformable` | the deformable insert: pressure under which an elastic body just touches the femur |
//! | `known_compliance` | what was computed of an insert's compliance, for another run |
//! | `under_surface` | stress below the surface, and what has yielded there |
//! | `pressed` | what contacts have in common: shares under pressure, and what they add up to |
//! | `broad_phase` | which blocks of nodes may touch, by brute force or coherently |

mod broad_phase;
mod contact_patch;
mod deformable;
mod foundation;
mod history;
mod law;
mod model;
mod pressure_law;
mod share_block;

pub use broad_phase::Search;
pub use deformable::{Backside, Deformable, FrictionModel};
pub use foundation::Foundation;
pub use history::{CycleHistory, Moment, NodeHistory, Record, SlipWork};
pub use law::{
    BacksideAtRest, Bodies, ContactLaw, KnownCompliance, PlasticUnderSurface, Regime, UnderSurface,
};
pub use model::{
    ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, Flattened,
    Linearization, MAX_REGIONS, NotBorne, Response, Settled, StateField, Tangent, Tipped,
    TouchedNode,
};
pub use pressure_law::{
    PressureLaw, PressureTable, PressureTableError, confined_modulus, softening_modulus,
};
