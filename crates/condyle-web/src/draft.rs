//! A case of two meshes.

use std::{fs, path::Path};

use condyle_case::case::{DraftError, Drafted, Preset};

use crate::{
    failure::Failure,
    message::{Message, send},
};

/// Writes the case of two meshes at `path`; unit, axes and start are concluded from the shapes.
pub fn draft(path: &Path, femur: &Path, insert: &Path) -> Result<(), Failure> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let drafted = Drafted::new(Preset::StanmoreForce, None, [femur, insert], folder);
    let drafted = drafted.map_err(|error| match &error {
        DraftError::Case(problems) => Failure::from(problems),
        _ => Failure::of_words(error),
    })?;
    for remark in drafted.remarks {
        send(&Message::Remark(remark));
    }
    fs::write(path, drafted.text).map_err(|error| Failure::of_file(path, &error))
}
