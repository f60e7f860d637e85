//! `checksums`: the hash of every mesh of a run, by which damaged meshes are detected.
//!
//! A mesh does not change once it is written, so its hash is written with it, before the checkpoint that refers to
//! it. Each line has the format of `b3sum`: `b3sum --check checksums` verifies all of them.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use thiserror::Error;

use super::replace::replace_file;

pub(super) const CHECKSUMS: &str = "checksums";
const GAP: &str = "  ";

/// A mesh of a run that has changed since the run wrote it.
#[derive(Debug, Error)]
pub enum DamagedFile {
    /// The bytes have changed.
    #[error(
        "{}: the file is damaged: its bytes are not those that the run wrote (its hash is in {CHECKSUMS}); put it back \
         from a copy, or run the case again with --force",
        file.display()
    )]
    Changed {
        /// The file.
        file: PathBuf,
    },
    /// The file is missing or cannot be read.
    #[error(
        "{}: the run wrote this file, and it cannot be read: {source}; put it back from a copy, or run the case again with \
         --force",
        file.display()
    )]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The cause.
        source: io::Error,
    },
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

/// Writes the hash of a file's bytes, which replaces an earlier one.
pub(super) fn write_checksum(folder: &Path, name: &str, bytes: &[u8]) -> io::Result<()> {
    let mut lines = listed(folder);
    lines.retain(|(_, other)| other != name);
    lines.push((blake3::hash(bytes).to_hex().to_string(), name.to_owned()));
    lines.sort_by(|a, b| a.1.cmp(&b.1));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_changed_by_one_bit_is_found_and_one_written_again_is_not() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let file = folder.path().join("insert_0001.vtu");
        fs::write(&file, b"mesh").expect("it can be written");
        check_file(&file).expect("nothing is known of it");
        write_checksum(folder.path(), "insert_0001.vtu", b"mess").expect("it can be written");
        let said = check_file(&file).expect_err("it differs").to_string();
        assert!(
            said.contains("insert_0001.vtu: the file is damaged"),
            "{said}"
        );
        assert!(check_all(folder.path()).is_err());
        write_checksum(folder.path(), "insert_0001.vtu", b"mesh").expect("it can be written");
        check_all(folder.path()).expect("it is as it was written");
        fs::remove_file(&file).expect("it is there");
        let said = check_all(folder.path())
            .expect_err("it is gone")
            .to_string();
        assert!(said.contains("cannot be read"), "{said}");
    }
}
