//! Files in memory.

use std::collections::BTreeMap;
use std::io;
use std::path::{Component, Path, PathBuf};

use super::interface::Files;

/// Files in memory, each a path and its bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MemoryFiles {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl MemoryFiles {
    /// The same with a file at `path`, in place of one that was there.
    pub fn with(mut self, path: impl AsRef<Path>, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.insert(plain(path.as_ref()), bytes.into());
        self
    }
}

impl Files for MemoryFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let found = self.files.get(&plain(path));
        found.cloned().ok_or(io::ErrorKind::NotFound.into())
    }

    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf> {
        let looked_at = folder.join(written);
        let path = plain(&looked_at);
        if self.files.contains_key(&path) {
            Ok(path)
        } else {
            Err(looked_at)
        }
    }
}

/// A path without `.`, and without `..` but at its start.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if plain.file_name().is_some() => {
                plain.pop();
            }
            _ => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_found_from_its_folder() {
        let files = MemoryFiles::default().with("./knees/femur.stl", *b"solid");
        let found = files.find("../knees/femur.stl", Path::new("cases"));
        let found = found.expect("it is there");
        assert_eq!(files.read(&found).expect("it is there"), b"solid");
        assert_eq!(found, Path::new("knees/femur.stl"));
    }

    #[test]
    fn a_file_that_is_not_there_says_where_it_was_looked_for() {
        let files = MemoryFiles::default();
        let looked_at = files.find("a.stl", Path::new("cases"));
        assert_eq!(looked_at, Err(PathBuf::from("cases/a.stl")));
        let error = files.read(Path::new("a.stl")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
    }
}
