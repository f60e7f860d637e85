//! Mesh files as names and bytes.

use std::io::ErrorKind;
use std::path::Path;

use super::error::MeshFileError;
use crate::files::Files;

/// The ending of a file's name in small letters, without the dot.
fn ending(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

/// What makes a mesh of the bytes of a file; the path is for messages.
pub(super) type Parser<M> = fn(&Path, &[u8]) -> Result<M, MeshFileError>;

/// The parser for the ending of a name, out of `formats`: endings with their parsers.
pub(super) fn parser<M>(
    path: &Path,
    formats: &[(&str, Parser<M>)],
) -> Result<Parser<M>, MeshFileError> {
    let ending = ending(path);
    let mut known = formats.iter();
    match known.find(|(known, _)| *known == ending) {
        Some((_, parse)) => Ok(*parse),
        None => Err(MeshFileError::UnknownExtension {
            path: path.to_path_buf(),
            ending,
            known: listed(formats.iter().map(|(known, _)| *known)),
        }),
    }
}

/// Endings as a message gives them: `.inp, .msh`.
fn listed<'e>(endings: impl Iterator<Item = &'e str>) -> String {
    let dotted: Vec<String> = endings.map(|ending| format!(".{ending}")).collect();
    dotted.join(", ")
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
