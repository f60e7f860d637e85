//! The deformable insert: a rigid femur on an elastic body, without penalty.
//!
//! [`Deformable`] is the law. It makes a `DeformableContact`, which takes the gaps of the bodies at rest along the
//! insert's normals (`along_normal`) of the nodes that may touch (`candidate`), finds the loads under which they just
//! touch (`complementarity`, with the factor of `cholesky` and what has changed since in `changed_factor`; `clearance`
//! tells which gaps need not be looked at), and adds up what these do as in [`pressed`](super::pressed). How the surface
//! gives way (`compliance`) is computed by finite elements (`elastic_surface`, `unit_loads`), between the nodes that ever
//! come near (`near_matrix`), and may be known from another run. Where it gives way along itself too, friction makes it stick and slip (`friction`, with
//! the loads of `stick_slip` and what is remembered of them in `friction_memory`). Where an increment ends it says how much of every share presses (`covered`), and what the highest
//! pressure is (`peak`). Below the surface the insert may yield (`plastic`), and has stress there (`under_surface`); its backside is bonded, or rests
//! (`backside`). What loads and insert have to agree on is found in `turns`, led by mixing.

mod along_normal;
mod backside;
mod candidate;
mod changed_factor;
mod cholesky;
mod clearance;
mod complementarity;
mod compliance;
mod contact;
mod covered;
mod elastic_surface;
mod friction;
mod friction_memory;
mod law;
mod near_matrix;
mod peak;
mod plastic;
mod settings;
mod stick_slip;
#[cfg(test)]
mod tests;
mod tiles;
mod turns;
mod under_surface;
mod unit_loads;

pub use settings::{Backside, Deformable, FrictionModel};
