//! Files of a results folder: atomic replacement, the hashes by which damaged meshes are detected, and the lock.
//!
//! The hash of a mesh is written after it, before the checkpoint that refers to it. The last mesh is written again after the
//! final cycle; its hash is removed before. Each line of `checksums` has the format of `b3sum`: `b3sum --check checksums`
//! verifies all of them.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, ErrorKind, Write},
    path::{Path, PathBuf},
};

use thiserror::Error;

/// Writes `bytes` next to the file and renames them into its place, so that a run stopped
/// at any time leaves the old file or the new one, never half of one.
///
/// # Errors
/// The file cannot be written; the old file is unchanged, and no temporary file remains.
pub fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if is_device(path) {
        return fs::write(path, bytes);
    }
    write_part(path, bytes)?;
    fs::rename(part_file(path), path)
}

/// Writes a new file as [`replace_file`]; an existing one is kept.
///
/// # Errors
/// The file exists ([`ErrorKind::AlreadyExists`]), or it cannot be written.
pub fn create_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if path.symlink_metadata().is_ok() && !is_device(path) {
        return Err(ErrorKind::AlreadyExists.into());
    }
    replace_file(path, bytes)
}

/// Returns whether the path is a device or a pipe, such as /dev/stdout, which is written to, not replaced.
fn is_device(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Replaces a file as [`replace_file`], and waits until it is on the disk.
pub(super) fn replace_file_durably(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_part(path, bytes)?.sync_data()?;
    fs::rename(part_file(path), path)
}

/// Writes the part file of a file, and leaves none if that fails.
fn write_part(path: &Path, bytes: &[u8]) -> io::Result<File> {
    let part = part_file(path);
    // A link of that name would lead the bytes out of the folder: what is there is removed, and only a new file is
    // written.
    match fs::remove_file(&part) {
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let mut file = File::create_new(&part)?;
    if let Err(error) = file.write_all(bytes) {
        let _ = fs::remove_file(&part);
        return Err(error);
    }
    Ok(file)
}

/// Returns the name of a file while it is written. It is always the same, so that a resumed run replaces the file of
/// an interrupted one.
pub(super) fn part_file(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

pub(super) const CHECKSUMS: &str = "checksums";
const GAP: &str = "  ";

/// A mesh of a run that has changed since the run wrote it.
#[expect(missing_docs, reason = "the messages describe the variants and fields")]
#[derive(Debug, Error)]
pub enum DamagedFile {
    #[error(
        "{}: the file is damaged: its bytes are not those that the run wrote (its hash is in {CHECKSUMS}); restore it \
         from a copy, or run the case again with --force",
        file.display()
    )]
    Changed { file: PathBuf },
    #[error(
        "{}: the run wrote this file, and it cannot be read: {source}; restore it from a copy, or run the case again with \
         --force",
        file.display()
    )]
    Unreadable { file: PathBuf, source: io::Error },
}

/// Checks that a file has the bytes that the run wrote; accepts a file without a hash in its folder.
///
/// # Errors
/// The file has changed, or it is missing.
pub fn check_file(file: &Path) -> Result<(), DamagedFile> {
    let name = file.file_name().and_then(|name| name.to_str());
    let listed = listed(file.parent().unwrap_or(Path::new("")));
    let mut listed = listed.iter();
    match listed.find(|(_, other)| Some(other.as_str()) == name) {
        Some((hash, _)) => check(file, hash),
        None => Ok(()),
    }
}

pub(super) fn check_all(folder: &Path) -> Result<(), DamagedFile> {
    let listed = listed(folder);
    let mut files = listed.iter();
    files.try_for_each(|(hash, name)| check(&folder.join(name), hash))
}

pub(super) fn is_listed(name: &str) -> bool {
    let is_mesh = [".vtu", ".vtp"].iter().any(|ending| name.ends_with(ending));
    is_mesh && !name.contains('/')
}

/// Writes the hash of a file's bytes, which replaces an earlier one; without bytes, removes it.
pub(super) fn write_checksum(folder: &Path, name: &str, bytes: Option<&[u8]>) -> io::Result<()> {
    let before = listed(folder);
    let mut lines = before.clone();
    lines.retain(|(_, other)| other != name);
    lines.extend(bytes.map(|bytes| (blake3::hash(bytes).to_hex().to_string(), name.to_owned())));
    lines.sort_by(|a, b| a.1.cmp(&b.1));
    if lines == before {
        return Ok(());
    }
    let lines = lines
        .iter()
        .map(|(hash, name)| format!("{hash}{GAP}{name}\n"));
    replace_file(
        &folder.join(CHECKSUMS),
        lines.collect::<String>().as_bytes(),
    )
}

fn check(file: &Path, hash: &str) -> Result<(), DamagedFile> {
    let bytes = fs::read(file).map_err(|source| DamagedFile::Unreadable {
        file: file.to_owned(),
        source,
    })?;
    if blake3::hash(&bytes).to_hex().as_str() == hash {
        return Ok(());
    }
    Err(DamagedFile::Changed {
        file: file.to_owned(),
    })
}

fn listed(folder: &Path) -> Vec<(String, String)> {
    let text = fs::read_to_string(folder.join(CHECKSUMS)).unwrap_or_default();
    let lines = text.lines().filter_map(|line| line.split_once(GAP));
    lines
        .map(|(hash, name)| (hash.to_owned(), name.to_owned()))
        .collect()
}

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
    fn a_file_changed_by_one_bit_is_found_and_one_written_again_is_not() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let file = folder.path().join("insert_0001.vtu");
        fs::write(&file, b"mesh").expect("it can be written");
        check_file(&file).expect("nothing is known of it");
        write_checksum(folder.path(), "insert_0001.vtu", Some(b"mess")).expect("it can be written");
        let said = check_file(&file).expect_err("it differs").to_string();
        assert!(
            said.contains("insert_0001.vtu: the file is damaged"),
            "{said}"
        );
        assert!(check_all(folder.path()).is_err());
        write_checksum(folder.path(), "insert_0001.vtu", Some(b"mesh")).expect("it can be written");
        check_all(folder.path()).expect("it is as it was written");
        fs::remove_file(&file).expect("it is there");
        let said = check_all(folder.path())
            .expect_err("it is gone")
            .to_string();
        assert!(said.contains("cannot be read"), "{said}");
    }

    #[test]
    #[cfg(unix)]
    fn a_link_at_the_part_file_leads_no_bytes_out_of_the_folder() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let [foreign, file] = ["foreign", "summary.json"].map(|name| folder.path().join(name));
        fs::write(&foreign, "mine").expect("it can be written");
        for write in [replace_file, replace_file_durably] {
            std::os::unix::fs::symlink(&foreign, part_file(&file)).expect("it can be linked");
            write(&file, b"new").expect("it can be written");
            assert_eq!(fs::read(&foreign).expect("it is there"), b"mine");
            assert_eq!(fs::read(&file).expect("it is there"), b"new");
            assert!(!file.is_symlink() && part_file(&file).symlink_metadata().is_err());
        }
    }

    #[test]
    fn a_new_file_replaces_none_and_comes_whole() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let file = folder.path().join("case.toml");
        fs::write(part_file(&file), "of a killed command").expect("it can be written");
        create_file(&file, b"first").expect("nothing is in its place");
        let error = create_file(&file, b"second").expect_err("it is there");
        assert_eq!(error.kind(), ErrorKind::AlreadyExists);
        assert_eq!(fs::read(&file).expect("it is there"), b"first");
        assert!(!part_file(&file).exists());
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_device_is_written_to_and_stays() {
        let device = Path::new("/dev/null");
        replace_file(device, b"gone").expect("it takes everything");
        create_file(device, b"gone").expect("it takes everything");
        assert!(!device.metadata().expect("it is there").is_file());
    }

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
    fn a_file_that_a_killed_run_left_locks_no_run_out() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        fs::write(folder.path().join(LOCK), "").expect("it can be written");
        let taken = FolderLock::take(folder.path());
        assert!(taken.expect("it can be written").is_some());
    }
}
