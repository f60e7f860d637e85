//! Where the files that a file names are looked for.

use std::path::Path;
use std::sync::Arc;

use crate::files::Files;

/// Where the files that a file names are looked for.
#[derive(Clone, Copy, Debug)]
pub struct Base<'a> {
    /// What has them.
    pub(crate) files: &'a Arc<dyn Files>,
    /// The folder that their paths count from.
    pub(crate) folder: &'a Path,
}

impl<'a> Base<'a> {
    /// The folder of the file at `path`.
    pub(crate) fn of(files: &'a Arc<dyn Files>, path: &'a Path) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self { files, folder }
    }
}
