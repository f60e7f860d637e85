//! The last step: from a case to bodies and machine in mm, N, s, MPa, tonne and rad.

mod assemble;
mod checks;
mod error;
mod femur;
mod insert;
mod machine;
mod misfit;
mod placing;
mod shared;
mod size;
#[cfg(test)]
mod tests;

pub use assemble::Built;
pub use error::{Body, BuildError, BuildWarning};
pub use femur::FEMUR_TRIANGLES;
pub use shared::SharedBodies;

pub(super) use error::Finding;
#[cfg(feature = "file-system")]
pub(super) use misfit::advice;

#[cfg(feature = "file-system")]
pub(super) use {
    checks::{MAX_ACROSS_MM, longest_mm, usual_unit},
    insert::{cut_at, heights_to_write, rounded_up},
    placing::{WrittenRotation, checked, checks_of, middle_of_mesh},
};
