//! Files that are whole or not there.

use std::path::PathBuf;

use crate::error::ReportError;

/// Writes a text and returns its path.
pub(crate) fn write_text(path: PathBuf, text: &str) -> Result<PathBuf, ReportError> {
    // Beside it and then in its place in one step: a stop leaves the old page or the new one.
    let mut beside = path.clone().into_os_string();
    beside.push(".part");
    match std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, &path)) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}
