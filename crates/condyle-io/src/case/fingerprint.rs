//! A hash of everything that goes into a run.

use std::io;

use super::contents::Case;
use crate::config::DataFile;

impl Case {
    /// Hash of the case as run and of the bytes of its meshes, in hexadecimal.
    ///
    /// Where the meshes lie does not count, what is in them does.
    ///
    /// # Errors
    /// A mesh that can no longer be read.
    pub fn inputs_blake3(&self) -> io::Result<String> {
        let mut text = self.to_toml();
        let mut hasher = blake3::Hasher::new();
        for file in [self.femur.file(), self.insert.file()]
            .into_iter()
            .flatten()
        {
            text = without_path(&text, file);
            hasher.update(blake3::hash(&file.files().read(file.path())?).as_bytes());
        }
        hasher.update(text.as_bytes());
        Ok(hasher.finalize().to_hex().to_string())
    }
}

/// A case as written, without the path of a file and without the blanks that fill its line up to
/// the comment, which are as many as the path is short.
fn without_path(text: &str, file: &DataFile) -> String {
    let path = toml::Value::String(file.path().to_string_lossy().into_owned()).to_string();
    let mut parts = text.split(&path);
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |before, after| {
        before + " " + after.trim_start_matches(' ')
    })
}
