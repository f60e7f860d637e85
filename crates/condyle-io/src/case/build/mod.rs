//! The last step: from a case to bodies and machine in mm, N, s, MPa, tonne and rad.

mod assemble;
mod error;
mod femur;
mod insert;
mod machine;
mod meshes;
#[cfg(test)]
mod tests;

pub use assemble::Built;
pub use error::{BuildError, BuildWarning};
