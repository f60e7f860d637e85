//! Cases read from the disk.

use std::fs;
use std::path::Path;

use super::assignment::{Assignment, ChangeError};
use super::contents::Case;
use super::machine_write::write_name;
use super::overriding::Override;
use super::reader::CaseReader;
use crate::config::Problems;
use crate::files::Disk;

impl Default for CaseReader {
    fn default() -> Self {
        Self::new(Disk)
    }
}

impl Case {
    /// Reads the case file at `path` on the disk; paths in it count from its folder.
    ///
    /// # Errors
    /// As [`CaseReader::read`].
    pub fn read(path: &Path) -> Result<Self, Problems> {
        CaseReader::default().read(path)
    }

    /// Reads the case file at `path` with one number changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_with`].
    pub fn read_with(path: &Path, number: &Override) -> Result<Self, Problems> {
        CaseReader::default().read_with(path, number)
    }

    /// Reads the case file at `path` with some of its values changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_changed`].
    pub fn read_changed(path: &Path, changes: &[Assignment]) -> Result<Self, ChangeError> {
        CaseReader::default().read_changed(path, changes)
    }

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// As [`CaseReader::parse`].
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, Problems> {
        CaseReader::default().parse(text, name, folder)
    }

    /// The case as [`Self::to_toml`] has it, to be kept in `folder`, which is there: its files by
    /// their paths counted from that folder, so that nothing in it names a place of one machine.
    pub fn to_toml_in(&self, folder: &Path) -> String {
        self.named_from(folder).to_toml()
    }

    /// The same, with waveforms by their names, as a case to go on from.
    pub(super) fn as_draft_in(&self, folder: &Path) -> String {
        self.named_from(folder).written(write_name)
    }

    /// The case with its files named from `folder`.
    fn named_from(&self, folder: &Path) -> Self {
        let mut case = self.clone();
        if let Ok(folder) = fs::canonicalize(folder) {
            let files = [case.femur.file_mut(), case.insert.file_mut()];
            for file in files.into_iter().flatten() {
                *file = file.named_from(&folder);
            }
        }
        case
    }
}
