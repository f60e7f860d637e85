//! Files on the disk.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::interface::Files;

/// Files on the disk; what is found is absolute, without `..` or links.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        fs::read(path)
    }

    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf> {
        let path = folder.join(written);
        match path.canonicalize() {
            Ok(found) if found.is_file() => Ok(found),
            Ok(_) | Err(_) => Err(path),
        }
    }
}
