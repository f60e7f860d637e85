//! The last step: from a case to bodies and machine in mm, N, s, MPa, tonne and rad.

mod activities;
mod assemble;
mod body_size;
mod construct;
mod error;
mod femur;
mod femur_triangles;
mod insert;
mod known_compliance;
mod lie;
mod machine;
mod meshes;
mod off_centre;
mod pieces;
mod rigid_motion;
mod shared;
#[cfg(test)]
mod tests;
mod wrong_axes;

pub use assemble::Built;
#[cfg(feature = "file-system")]
pub(super) use construct::{cut_at, heights_to_write, rounded_up};
pub use error::{BuildError, BuildWarning};
pub use femur_triangles::FEMUR_TRIANGLES;
pub(crate) use femur_triangles::in_four;
#[cfg(feature = "file-system")]
pub(super) use lie::{longest_mm, usual_unit};
#[cfg(feature = "file-system")]
pub(super) use meshes::checks_of;
#[cfg(feature = "file-system")]
pub(super) use off_centre::MAX_ACROSS_MM;
pub use pieces::StrayPiece;
#[cfg(feature = "file-system")]
pub(super) use rigid_motion::middle_of_mesh;
pub use shared::SharedBodies;
pub use wrong_axes::{Body, WrongAxes};
