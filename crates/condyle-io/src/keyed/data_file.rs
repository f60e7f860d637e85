//! Files that a file names.

use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::DeValue;

use super::file_reason::FileReason;
use super::key::Key;
use super::log::Log;
use super::section::Section;
use super::setting::Setting;
use super::source::{Source, read_source};
use super::value::quoted;
use super::words::wrong_type;

/// A file that another names, and that was there when that one was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// Absolute, without `..` or links.
    path: PathBuf,
}

impl DataFile {
    /// The file at `written`, counted from `folder`.
    ///
    /// # Errors
    /// The path that was looked at, where there is no such file.
    pub fn find(written: &str, folder: &Path) -> Result<Self, PathBuf> {
        let path = folder.join(written);
        match path.canonicalize() {
            Ok(found) if found.is_file() => Ok(Self { path: found }),
            Ok(_) | Err(_) => Err(path),
        }
    }

    /// Where it is, absolute.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its name without its folder.
    pub(crate) fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// Its text, or the reason at the key `key` of `section` that names it.
    pub(crate) fn source(
        &self,
        section: &Section<'_>,
        key: &str,
        log: &mut Log<'_>,
    ) -> Option<Source> {
        let source = read_source(&self.path);
        source
            .map_err(|reason| log.problem(section.value_span(key), reason))
            .ok()
    }
}

impl Setting for DataFile {
    fn kind() -> String {
        "a path in quotes".to_owned()
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let Some(written) = value.get_ref().as_str() else {
            wrong_type(value, key, log);
            return None;
        };
        match Self::find(written, log.folder()) {
            Ok(file) => Some(file),
            Err(path) => {
                let key = key.name.to_owned();
                log.problem(value.span(), FileReason::Missing { key, path });
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(quoted(&self.path.display().to_string()))
    }
}
