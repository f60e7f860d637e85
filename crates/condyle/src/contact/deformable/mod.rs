//! The deformable insert: a rigid femur on an elastic body, without penalty.
//!
//! [`Deformable`] is the law. It makes a `DeformableContact`, which takes the gaps of the bodies at rest along the
//! insert's normals (`along_normal`) of the nodes that may touch (`candidate`), finds the loads under which they just
//! touch (`complementarity`, with the factor of `cholesky` and what has changed since in `changed_factor`; `clearance`
//! tells which gaps need not be looked at), and adds up what these do as in [`pressed`](super::pressed). How the surface
//! gives way (`compliance`) is computed by finite elements (`elastic_surface`), between the nodes that ever come near
//! (`near_matrix`). Where an increment ends it says how much of every share presses (`covered`), and what the highest
//! pressure is (`peak`). Below the surface the insert may yield (`plastic`), and has stress there (`under_surface`).

mod along_normal;
mod candidate;
mod changed_factor;
mod cholesky;
mod clearance;
mod complementarity;
mod compliance;
mod contact;
mod covered;
mod elastic_surface;
mod law;
mod near_matrix;
mod peak;
mod plastic;
mod settings;
#[cfg(test)]
mod tests;
mod tiles;
mod under_surface;

pub use settings::Deformable;
