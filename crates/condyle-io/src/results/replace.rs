//! A file is replaced whole or not at all.

use std::{fs, io, path::Path};

/// Writes `bytes` beside the file and puts them in its place in one step, so that a run stopped
/// at any time leaves the old file or the new one, never half of one.
pub(super) fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    fs::write(&beside, bytes)?;
    fs::rename(&beside, path)
}

/// As [`replace_file`], and waits until the disk has it.
pub(super) fn replace_file_durably(path: &Path, bytes: &[u8]) -> io::Result<()> {
    use io::Write;
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut beside = tempfile::NamedTempFile::new_in(folder)?;
    beside.write_all(bytes)?;
    beside.as_file().sync_data()?;
    beside.persist(path)?;
    Ok(())
}
