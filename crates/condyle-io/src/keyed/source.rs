//! Named texts that problems point into.

use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;

use super::file_reason::FileReason;

/// A named text that problems point into.
pub(crate) type Source = Arc<NamedSource<String>>;

/// Reads a file; the name under which problems show it is its path.
pub(crate) fn read_source(path: &Path) -> Result<Source, FileReason> {
    let name = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(Arc::new(NamedSource::new(name, text))),
        Err(error) => Err(FileReason::Unreadable {
            path: path.to_path_buf(),
            why: error.to_string(),
        }),
    }
}
