//! Errors of mesh files.

use std::path::{Path, PathBuf};

/// An error of reading or writing a mesh file.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// The file does not exist.
    #[error("{}: there is no such file; check the path", path.display())]
    Missing { path: PathBuf },
    /// The system refuses to read the file.
    #[error("{}: cannot be read: {source}", path.display())]
    Inaccessible {
        path: PathBuf,
        source: std::io::Error,
    },
    /// The file's extension is not a known format for this use.
    #[error("{}: the extension {ending:?} is not a known format; use one of {known}", path.display())]
    UnknownExtension {
        path: PathBuf,
        ending: String,
        known: String,
    },
    /// The content does not follow the format, or is not a mesh that can be computed with.
    #[error("{}{}: {problem}", path.display(), line.map_or_else(String::new, |line| format!(":{line}")))]
    Content {
        path: PathBuf,
        line: Option<usize>,
        problem: String,
    },
    /// An array to be written does not have one value per node.
    #[error("array {name:?} has {values} values for {nodes} nodes; give one value per node")]
    ArrayLength {
        name: String,
        values: usize,
        nodes: usize,
    },
}

impl MeshFileError {
    /// Returns the file at fault; none if the fault is in values given by the caller.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Missing { path }
            | Self::Inaccessible { path, .. }
            | Self::UnknownExtension { path, .. }
            | Self::Content { path, .. } => Some(path),
            Self::ArrayLength { .. } => None,
        }
    }
}
