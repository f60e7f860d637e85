//! The last step: from a case to bodies and machine in mm, N, s, MPa, tonne and rad.

mod assemble;
mod body_size;
mod error;
mod femur;
mod femur_triangles;
mod insert;
mod machine;
mod meshes;
mod pieces;
#[cfg(test)]
mod tests;

pub use assemble::Built;
pub use error::{BuildError, BuildWarning};
pub use pieces::StrayPiece;
