//! What is asked of files.

use std::fmt::Debug;
use std::io;
use std::path::{Path, PathBuf};

/// Files that can be found and read.
pub trait Files: Debug + Send + Sync {
    /// The bytes of the file at `path`.
    ///
    /// # Errors
    /// A file that is not there ([`io::ErrorKind::NotFound`]) or cannot be read.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// The path of the file `written`, counted from `folder`, under which it can be read from
    /// anywhere.
    ///
    /// # Errors
    /// The path that was looked at, where there is no such file.
    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf>;
}
