//! The bytes of a file, and numbers in text.

use std::{io::ErrorKind, path::Path, str::FromStr};

use super::error::{FileLine, MeshFileError};
use crate::files::Files;

/// Content of a text format; bytes that are not UTF-8 can only be in names and comments,
/// and are replaced.
pub(crate) fn decode(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// A number out of a text file.
pub(crate) fn number<T: FromStr>(path: &Path, line: usize, word: &str) -> Result<T, MeshFileError> {
    let word = word.trim();
    word.parse()
        .map_err(|_| FileLine::line(path, line).error(format!("{word:?} is not a number here")))
}

/// The next three words as coordinates.
pub(crate) fn coordinates<'w>(
    path: &Path,
    line: usize,
    words: &mut impl Iterator<Item = &'w str>,
) -> Result<[f64; 3], MeshFileError> {
    let mut point = [0.0; 3];
    for coordinate in &mut point {
        let word = words
            .next()
            .ok_or_else(|| FileLine::line(path, line).error("a point needs three coordinates"))?;
        *coordinate = number(path, line, word)?;
    }
    Ok(point)
}

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
