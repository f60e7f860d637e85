//! A hash of everything that goes into a run.

use std::{fs, io};

use super::contents::Case;
use crate::keyed::DataFile;

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
            text = text.replace(&path_in_toml(file), "");
            hasher.update(blake3::hash(&fs::read(file.path())?).as_bytes());
        }
        hasher.update(text.as_bytes());
        Ok(hasher.finalize().to_hex().to_string())
    }
}

/// The file's path as a case writes it.
fn path_in_toml(file: &DataFile) -> String {
    toml::Value::String(file.path().to_string_lossy().into_owned()).to_string()
}
