//! Problems of keys, values and files.

use std::error::Error;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A problem of a file as data; `Display` describes it.
///
/// Every part of a file has reasons of its own, each an enum with fields or a struct.
pub trait Reason: Error + Send + Sync + 'static {
    /// Returns the remedy, if it does not follow from the description.
    fn advice(&self) -> Option<String>;
}

/// A key or a value that cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KeyReason {
    /// Not TOML.
    #[error("this is not TOML: {message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// A key that does not exist.
    #[error("{section} has no key `{key}`")]
    UnknownKey {
        /// As written.
        key: String,
        /// The table it stands in.
        section: String,
        /// A key that looks like it.
        near: Option<String>,
        /// Every key there is.
        keys: Vec<String>,
    },
    /// A key that exists with another unit.
    #[error("`{key}` is in another unit: the key is `{meant}`, in {unit}")]
    WrongUnit {
        /// As written.
        key: String,
        /// The key that is meant.
        meant: String,
        /// Its unit.
        unit: &'static str,
        /// The same value in that unit, where it is known.
        converted: Option<String>,
    },
    /// A key that belongs to another choice.
    #[error("`{key}` belongs to {owner}, but this case has {chosen}")]
    OtherChoice {
        /// As written.
        key: String,
        /// Such as `shape = "mesh"`.
        owner: String,
        /// Such as `shape = "generic"`.
        chosen: String,
    },
    /// A value of another type.
    #[error("`{key}` must be {wanted}, this is {found}")]
    WrongType {
        /// The key.
        key: String,
        /// What it takes.
        wanted: String,
        /// What it got.
        found: &'static str,
    },
    /// A word that is none of the choices.
    #[error("`{key}` cannot be \"{word}\"")]
    UnknownWord {
        /// The key.
        key: String,
        /// As written.
        word: String,
        /// A choice that looks like it.
        near: Option<String>,
        /// Every choice.
        words: String,
    },
    /// A number outside its range.
    #[error("`{key}` is {value}, outside its range")]
    OutOfRange {
        /// The key.
        key: String,
        /// As written.
        value: String,
        /// The range with its unit.
        range: String,
    },
    /// A key that must be there.
    #[error("{section} needs `{key}`")]
    MissingKey {
        /// The key.
        key: String,
        /// The table it is missing from.
        section: String,
        /// What it takes.
        wanted: String,
    },
    /// Two keys that exclude each other.
    #[error("{section} has both `{first}` and `{second}`, which say the same thing twice")]
    Both {
        /// The table.
        section: String,
        /// One key.
        first: String,
        /// The other.
        second: String,
    },
    /// None of the keys of which one is needed.
    #[error("{section} needs one of {keys}")]
    NoneOf {
        /// The table.
        section: String,
        /// The keys.
        keys: String,
    },
    /// A key that means nothing without another.
    #[error("`{key}` means nothing here: it needs {needs}")]
    Idle {
        /// The key.
        key: String,
        /// What it needs.
        needs: String,
    },
}

impl Reason for KeyReason {
    fn advice(&self) -> Option<String> {
        match self {
            Self::UnknownKey {
                near: Some(near), ..
            } => Some(format!("did you mean `{near}`?")),
            Self::UnknownKey { keys, .. } => {
                Some(format!("remove it; the keys here are {}", keys.join(", ")))
            }
            Self::WrongUnit {
                meant,
                converted: Some(value),
                ..
            } => Some(format!("write `{meant} = {value}`")),
            Self::WrongUnit { meant, unit, .. } => {
                Some(format!("write `{meant}`, with the value in {unit}"))
            }
            Self::OtherChoice { owner, .. } => Some(format!("remove it, or write `{owner}`")),
            Self::UnknownWord { near, words, .. } => Some(match near {
                Some(near) => format!("did you mean \"{near}\"? It can be {words}"),
                None => format!("it can be {words}"),
            }),
            Self::OutOfRange { range, .. } => Some(format!("it can be {range}")),
            Self::MissingKey { key, wanted, .. } => Some(format!("add `{key} = `, {wanted}")),
            Self::Both { first, second, .. } => {
                Some(format!("keep `{first}` or `{second}`, not both"))
            }
            Self::Idle { key, .. } => Some(format!("remove `{key}`, or add what it needs")),
            Self::Syntax { .. } => Some(SYNTAX_ADVICE.to_owned()),
            Self::WrongType { .. } | Self::NoneOf { .. } => None,
        }
    }
}

const SYNTAX_ADVICE: &str = "a line is `key = value`: text in quotes, a number without its unit, \
    a list in square brackets; a key stands once in its table";

/// A file that cannot be used.
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
