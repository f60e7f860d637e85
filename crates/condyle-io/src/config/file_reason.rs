//! What is wrong with a file that is named.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::reason::Reason;

/// Why a file cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FileReason {
    /// A file that is not there.
    #[error("`{key}`: there is no file {}", path.display())]
    Missing {
        /// The key that names it.
        key: String,
        /// Where it was looked for.
        path: PathBuf,
    },
    /// A file that cannot be read.
    #[error("the file {} cannot be read: {why}", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        why: String,
    },
}

impl Reason for FileReason {
    fn advice(&self) -> Option<String> {
        match self {
            Self::Missing { path, .. } => Some(how_to_get(path).to_owned()),
            Self::Unreadable { .. } => None,
        }
    }
}

/// Where a file that is not there comes from.
fn how_to_get(path: &Path) -> &'static str {
    if path.iter().any(|part| part == "dm-knee") {
        "data are not part of condyle: fetch the Grand Challenge subject DM meshes and gait \
         (Fregly et al. 2012; in jam-resources, models/knee_tka/grand_challenge/DM) and put them \
         there; see the comment at the top of the case"
    } else if path.iter().any(|part| part == "data") {
        "data are not part of condyle: the comment at the top of the case says where they come \
         from"
    } else {
        "correct the path; it counts from the folder of the file that names it"
    }
}
