//! Files behind an interface: on a disk, or as bytes in memory for a browser or another program.
//!
//! ```
//! use std::path::Path;
//! use condyle_mesh::files::{Files, MemoryFiles};
//!
//! let files = MemoryFiles::default().with("knees/femur.stl", *b"solid");
//! let path = files.find("../knees/femur.stl", Path::new("cases")).unwrap();
//! assert_eq!(files.read(&path)?, b"solid");
//! # Ok::<(), std::io::Error>(())
//! ```

use std::{
    collections::BTreeMap,
    fmt::Debug,
    io,
    path::{Component, Path, PathBuf},
};
#[cfg(feature = "file-system")]
use std::{
    fs::{File, Metadata},
    io::Read,
};

/// Files that can be found and read.
pub trait Files: Debug + Send + Sync {
    /// Reads the bytes of the file at `path`.
    ///
    /// # Errors
    /// A file that does not exist ([`io::ErrorKind::NotFound`]) or cannot be read.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// Returns the path under which the file `written`, relative to `folder`, can be read from
    /// anywhere.
    ///
    /// # Errors
    /// The path that was tried, if there is no such file.
    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf>;
}

/// Files in memory, each a path and its bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MemoryFiles {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl MemoryFiles {
    /// Adds or replaces the file at `path`.
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

/// Returns a path without `.`, and with `..` at its start only.
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

/// Files on the disk.
///
/// Paths found are absolute, in a folder without `..` or links. The last part of the path stays as written even
/// if it is a link, since its extension gives the format.
#[cfg(feature = "file-system")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disk;

/// The largest file that is read: twenty million triangles of a binary STL. A larger one is hardly an implant, and would
/// fill the memory before anything could be said about it.
#[cfg(feature = "file-system")]
const MAX_FILE_BYTES: u64 = 1 << 30;
/// The most that is read from a pipe or device, which may never end.
#[cfg(feature = "file-system")]
const MAX_STREAM_BYTES: u64 = 1 << 26;

#[cfg(feature = "file-system")]
impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let file = File::open(path)?;
        let there = file.metadata()?;
        let limit = limit_of(&there);
        if there.len() > limit {
            return Err(too_large(limit));
        }
        read_up_to(limit, file)
    }

    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf> {
        let path = folder.join(written);
        let true_path = || {
            let parent = path.parent()?;
            let is_here = parent.as_os_str().is_empty();
            let parent = if is_here { Path::new(".") } else { parent };
            Some(parent.canonicalize().ok()?.join(path.file_name()?))
        };
        true_path().filter(|found| found.is_file()).ok_or(path)
    }
}

#[cfg(feature = "file-system")]
fn limit_of(there: &Metadata) -> u64 {
    match there.is_file() {
        true => MAX_FILE_BYTES,
        false => MAX_STREAM_BYTES,
    }
}

/// Reads a file whose length may be unknown, as that of a pipe.
#[cfg(feature = "file-system")]
fn read_up_to(limit: u64, file: File) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match file.take(limit + 1).read_to_end(&mut bytes)? as u64 {
        length if length > limit => Err(too_large(limit)),
        _ => Ok(bytes),
    }
}

#[cfg(feature = "file-system")]
fn too_large(limit: u64) -> io::Error {
    let megabytes = limit >> 20;
    let why = format!("it holds more than {megabytes} MiB, the most that is read");
    io::Error::new(io::ErrorKind::FileTooLarge, why)
}

/// Returns the path of `file` relative to `folder`, both absolute and without `..` or links; none if
/// they have nothing in common, as on two drives.
#[cfg(feature = "file-system")]
pub fn path_from(folder: &Path, file: &Path) -> Option<PathBuf> {
    let both = folder.components().zip(file.components());
    let common = both.take_while(|(one, other)| one == other).count();
    let up = folder
        .components()
        .skip(common)
        .map(|_| Component::ParentDir);
    let down = file.components().skip(common);
    (common > 0).then(|| up.chain(down).collect())
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
    fn a_missing_file_gives_the_path_that_was_tried() {
        let files = MemoryFiles::default();
        let looked_at = files.find("a.stl", Path::new("cases"));
        assert_eq!(looked_at, Err(PathBuf::from("cases/a.stl")));
        let error = files.read(Path::new("a.stl")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_without_end_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let sparse = folder.path().join("huge.stl");
        File::create(&sparse).unwrap().set_len(1 << 40).unwrap();
        for (path, limit) in [(Path::new("/dev/zero"), "64 MiB"), (&sparse, "1024 MiB")] {
            let error = Disk.read(path).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
            assert!(error.to_string().contains(limit), "{error}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_keeps_its_own_name_in_the_true_folder() {
        use std::{fs, os::unix::fs::symlink};
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        fs::create_dir(root.join("store")).unwrap();
        fs::write(root.join("store/0a1b2c"), "solid").unwrap();
        symlink("store/0a1b2c", root.join("linked.stl")).unwrap();
        symlink("store", root.join("meshes")).unwrap();
        symlink("nowhere", root.join("broken.stl")).unwrap();
        let found = Disk.find("store/../linked.stl", &root).unwrap();
        assert_eq!(found, root.join("linked.stl"));
        assert_eq!(Disk.read(&found).unwrap(), b"solid");
        let inside = Disk.find("meshes/0a1b2c", &root).unwrap();
        assert_eq!(inside, root.join("store/0a1b2c"));
        for none in ["broken.stl", "store", ".."] {
            assert_eq!(Disk.find(none, &root), Err(root.join(none)));
        }
    }

    #[cfg(unix)]
    #[test]
    fn up_to_what_is_common_and_down_again() {
        let from = |folder, file| path_from(Path::new(folder), Path::new(file));
        assert_eq!(from("/a/b", "/a/b/c.stl"), Some("c.stl".into()));
        assert_eq!(from("/a/b/c", "/a/d/e.stl"), Some("../../d/e.stl".into()));
        assert_eq!(from("/a", "/b.stl"), Some("../b.stl".into()));
        assert_eq!(from("a", "b.stl"), None);
    }
}
