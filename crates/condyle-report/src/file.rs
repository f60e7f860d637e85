//! Atomic writing of files.

use std::path::PathBuf;

use crate::error::ReportError;

/// Writes a text and returns its path.
pub(crate) fn write_text(path: PathBuf, text: &str) -> Result<PathBuf, ReportError> {
    // Written next to its place and renamed in one step: an interruption leaves the old file or the new one.
    let mut part = path.clone().into_os_string();
    part.push(".part");
    match std::fs::write(&part, text).and_then(|()| std::fs::rename(&part, &path)) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}
