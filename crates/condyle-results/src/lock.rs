//! The lock of a results folder, which belongs to one run at a time.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

/// The file that a run holds locked as long as it writes.
pub(super) const LOCK: &str = "in_use";

/// A folder that no other run writes into. The system releases the lock whenever the program ends; a file that
/// remains does not lock out other runs.
#[derive(Debug)]
pub struct FolderLock {
    path: PathBuf,
    /// Holds the lock as long as it is open.
    _file: File,
}

impl FolderLock {
    /// Locks the existing folder `folder`; none if another run holds the lock.
    pub(super) fn take(folder: &Path) -> io::Result<Option<Self>> {
        let path = folder.join(LOCK);
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(false);
        loop {
            let file = options.open(&path)?;
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => return Ok(None),
                // A file system without locks is better than no run.
                Err(TryLockError::Error(error)) if error.kind() != ErrorKind::Unsupported => {
                    return Err(error);
                }
                // A run that has just ended removed this file, so that a lock on it excludes no other run.
                Ok(()) if !path.exists() => {}
                Ok(()) | Err(_) => return Ok(Some(Self { path, _file: file })),
            }
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time_and_nothing_is_left_behind() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let take = || FolderLock::take(folder.path()).expect("it can be written");
        let first = take();
        assert!(first.is_some() && take().is_none());
        drop(first);
        assert!(!folder.path().join(LOCK).exists());
        assert!(take().is_some());
    }

    #[test]
    fn a_file_that_a_killed_run_left_locks_nobody_out() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        fs::write(folder.path().join(LOCK), "").expect("it can be written");
        let taken = FolderLock::take(folder.path());
        assert!(taken.expect("it can be written").is_some());
    }
}
