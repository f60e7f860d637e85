//! Files on the disk.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::interface::Files;

/// Files on the disk; what is found is absolute, in a folder without `..` or links. Its own name is
/// the one written, whatever that links to, since a name says of what format a file is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        fs::read(path)
    }

    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf> {
        let path = folder.join(written);
        match in_true_folder(&path) {
            Some(found) if found.is_file() => Ok(found),
            Some(_) | None => Err(path),
        }
    }
}

/// The file of that name in the folder that its path leads to.
fn in_true_folder(path: &Path) -> Option<PathBuf> {
    let folder = match path.parent()? {
        here if here.as_os_str().is_empty() => Path::new("."),
        folder => folder,
    };
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn a_link_keeps_its_own_name_in_the_true_folder() {
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
}
