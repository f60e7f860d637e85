//! Named texts that problems point into.

use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;

use super::file_reason::FileReason;
use crate::files::Files;

/// A named text that problems point into.
pub(crate) type Source = Arc<NamedSource<String>>;

/// Reads a file; the name under which problems show it is its path.
pub(crate) fn read_source(files: &dyn Files, path: &Path) -> Result<Source, FileReason> {
    let name = path.display().to_string();
    let unreadable = |why: String| {
        let path = path.to_path_buf();
        FileReason::Unreadable { path, why }
    };
    let bytes = files
        .read(path)
        .map_err(|error| unreadable(error.to_string()))?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Arc::new(NamedSource::new(name, text))),
        Err(_) => Err(unreadable("stream did not contain valid UTF-8".to_owned())),
    }
}
