//! Reasons for which a case cannot be exported.

use std::io;

use condyle::evolve::{MarchError, PlacementError};
use thiserror::Error;

use crate::case::BuildError;

/// A case that cannot be exported.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The case does not build.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The femur cannot be placed on the insert.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A choice of the case that the exported model does not have.
    #[error("the exported file has {supported}, and this case has {found}; write {remedy}")]
    Unsupported {
        /// The model that is exported.
        supported: &'static str,
        /// The setting of the case.
        found: String,
        /// The setting that can be exported.
        remedy: &'static str,
    },
    /// The bodies do not touch at this place of the cycle.
    #[error("nothing touches at {percent} % of the cycle; choose another place")]
    Apart {
        /// Place in the cycle, %.
        percent: f64,
    },
    /// The first cycle could not be solved.
    #[error(transparent)]
    Cycle(Box<MarchError>),
    /// The file cannot be written.
    #[error("the exported file cannot be written: {source}; check the disk and the folder")]
    Write {
        /// The error of the writer.
        source: io::Error,
    },
}
