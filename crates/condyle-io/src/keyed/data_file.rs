//! Files that a case names.

use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::DeValue;

use super::keys::Key;
use super::parse::Log;
use super::problems::Reason;
use super::setting::{Setting, quoted, wrong_type};

/// A file that a case names and that was there when the case was read.
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
                log.problem(value.span(), Reason::MissingFile { key, path });
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(quoted(&self.path.display().to_string()))
    }
}
