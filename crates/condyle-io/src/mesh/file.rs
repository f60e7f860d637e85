//! Mesh files as names and bytes.

use std::io::ErrorKind;
use std::path::Path;

use super::error::MeshFileError;
use crate::files::Files;

/// The ending of a file's name in small letters, without the dot.
pub(super) fn ending(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

pub(super) fn unknown_ending(path: &Path, known: &'static str) -> MeshFileError {
    MeshFileError::UnknownExtension {
        path: path.to_path_buf(),
        ending: ending(path),
        known,
    }
}

pub(super) fn read_bytes(files: &dyn Files, path: &Path) -> Result<Vec<u8>, MeshFileError> {
    files.read(path).map_err(|source| {
        let path = path.to_path_buf();
        if source.kind() == ErrorKind::NotFound {
            MeshFileError::Missing { path }
        } else {
            MeshFileError::Unreadable { path, source }
        }
    })
}
