//! Why there is no draft.

use std::path::PathBuf;

use condyle::geometry::ShellError;
use thiserror::Error;

use crate::{case::build::Body, config::Problems, mesh::MeshFileError};

/// Why no case can be drafted from two files.
#[derive(Debug, Error)]
pub enum DraftError {
    /// A file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// Triangles that are no shell.
    #[error("{}: {source}", file.display())]
    Shell {
        /// The file.
        file: PathBuf,
        /// Why.
        source: ShellError,
    },
    /// A body that no unit makes as large as a knee's.
    #[error(
        "{}: this {body} is {size:.4} long in the unit of the file, and none of mm, cm, m and in makes it \
         40 mm to 120 mm long, as that of a whole knee is; scale it, or write the case by hand",
        file.display()
    )]
    NoUnit {
        /// The file.
        file: PathBuf,
        /// Which body.
        body: Body,
        /// Its longest extent, in the unit of the file.
        size: f64,
    },
    /// The draft is no case.
    #[error(transparent)]
    Case(#[from] Problems),
}
