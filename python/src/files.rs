//! Files of a case: some in memory, all others on the disk.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use condyle_mesh::files::{Disk, Files, MemoryFiles};

/// Files in memory over those on the disk, where relative paths count from a folder that stays what it was.
#[derive(Debug)]
pub struct FilesOfCase {
    memory: MemoryFiles,
    base: PathBuf,
}

impl FilesOfCase {
    /// `text` as the file at `path`, beside `files`.
    pub fn new(path: &Path, text: &str, base: PathBuf, files: BTreeMap<PathBuf, Vec<u8>>) -> Self {
        let memory = MemoryFiles::default().with(path, text);
        let memory = files
            .into_iter()
            .fold(memory, |memory, (path, bytes)| memory.with(path, bytes));
        Self { memory, base }
    }
}

impl Files for FilesOfCase {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let in_memory = self.memory.read(path);
        in_memory.or_else(|_| Disk.read(&self.base.join(path)))
    }

    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf> {
        let in_memory = self.memory.find(written, folder);
        in_memory.or_else(|_| Disk.find(written, &self.base.join(folder)))
    }
}
