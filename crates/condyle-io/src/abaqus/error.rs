//! Why a case makes no Abaqus file.

use std::io;

use condyle::evolve::PlacementError;
use thiserror::Error;

use crate::case::BuildError;

/// Why a case makes no Abaqus file.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The case does not build.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The femur finds no place on the insert.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A deformable insert, which the model that is written does not have.
    #[error(
        "the Abaqus model presses a rigid insert by a pressure law, and this case has a deformable one; write [contact] model = \"foundation\" for it"
    )]
    Deformable,
    /// The file cannot be written.
    #[error("the Abaqus file cannot be written: {source}; check the disk and the folder")]
    Write {
        /// Why.
        source: io::Error,
    },
}
