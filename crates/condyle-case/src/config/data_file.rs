//! Files that a file names.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::Spanned;
use toml::de::DeValue;

use super::key::Key;
use super::key::Kind;
use super::key::quoted;
use super::log::Log;
use super::problem::{Source, read_source};
use super::reason::missing_file;
use super::section::Section;
use super::setting::Setting;
use super::setting::wrong_type;
use condyle_mesh::files::Files;
#[cfg(feature = "file-system")]
use condyle_mesh::files::path_from;

/// A file that another file names, and that existed when the other was read.
///
/// Two files are equal if their paths are, whatever their storage.
#[derive(Clone, Debug)]
pub struct DataFile {
    files: Arc<dyn Files>,
    /// Absolute on a disk, its folder without `..` or links.
    path: PathBuf,
    /// The path as written in the file that names it.
    written: PathBuf,
}

impl PartialEq for DataFile {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl DataFile {
    /// Finds the file of `files` at the path `written`, relative to `folder`.
    ///
    /// # Errors
    /// The file does not exist; the error is the path that was searched.
    pub fn find(files: &Arc<dyn Files>, written: &str, folder: &Path) -> Result<Self, PathBuf> {
        let (path, files) = (files.find(written, folder)?, Arc::clone(files));
        let written = path.clone();
        Ok(Self {
            files,
            path,
            written,
        })
    }

    /// Returns the file with its path relative to `folder`, an absolute path without links.
    #[cfg(feature = "file-system")]
    pub(crate) fn named_from(&self, folder: &Path) -> Self {
        let mut file = self.clone();
        if let Some(written) = path_from(folder, &self.path) {
            file.written = written;
        }
        file
    }

    /// Returns the files that it is read from.
    pub fn files(&self) -> &dyn Files {
        self.files.as_ref()
    }

    /// Returns its path, absolute on a disk.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns its name without its folder.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// Reads its text, or reports a problem at the key `key` of `section`.
    pub(crate) fn source(
        &self,
        section: &Section<'_>,
        key: &str,
        log: &mut Log<'_>,
    ) -> Option<Source> {
        let source = read_source(self.files(), &self.path);
        source
            .map_err(|reason| log.problem(section.value_span(key), reason))
            .ok()
    }
}

impl Setting for DataFile {
    fn kind() -> Kind {
        Kind::Path
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let Some(written) = value.get_ref().as_str() else {
            wrong_type(value, key, log);
            return None;
        };
        let base = log.base();
        match Self::find(base.files, written, base.folder) {
            Ok(file) => Some(file),
            Err(path) => {
                log.problem(value.span(), missing_file(key.name, &path));
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(quoted(&self.written.display().to_string()))
    }
}
