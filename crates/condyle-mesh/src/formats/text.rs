//! Words and numbers of the text formats.

use std::path::Path;
use std::str::FromStr;

use super::error::{FileLine, MeshFileError};

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
