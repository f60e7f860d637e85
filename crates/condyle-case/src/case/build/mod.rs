//! The last step: from a case to bodies and machine in mm, N, s, MPa, tonne and rad.

mod assemble;
mod error;
mod femur;
mod insert;
mod machine;
mod meshes;
mod orientation_check;
mod rigid_motion;
mod shared;
mod size;
#[cfg(test)]
mod tests;
mod tray;

pub use assemble::Built;
pub use error::{Body, BuildError, BuildWarning, MeshFault, MeshRemark, StrayPiece, WrongAxes};
pub use femur::FEMUR_TRIANGLES;
pub use shared::SharedBodies;

pub(crate) use femur::in_four;

#[cfg(feature = "file-system")]
pub(super) use meshes::checks_of;
#[cfg(feature = "file-system")]
pub(super) use orientation_check::{MAX_ACROSS_MM, longest_mm, usual_unit};
#[cfg(feature = "file-system")]
pub(super) use rigid_motion::middle_of_mesh;
#[cfg(feature = "file-system")]
pub(super) use tray::{cut_at, heights_to_write, rounded_up};
