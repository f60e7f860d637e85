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

/// A problem and its remedy in words.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub(crate) struct Fault {
    message: String,
    advice: String,
}

impl Fault {
    pub(crate) fn new(message: impl Into<String>, advice: impl Into<String>) -> Self {
        let (message, advice) = (message.into(), advice.into());
        Self { message, advice }
    }
}

impl Reason for Fault {
    fn advice(&self) -> Option<String> {
        (!self.advice.is_empty()).then(|| self.advice.clone())
    }
}

/// A key or a value that cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum KeyReason {
    #[error("this is not TOML: {message}")]
    Syntax { message: String },
    #[error("{section} has no key `{key}`")]
    UnknownKey {
        key: String,
        section: String,
        near: Option<String>,
        keys: Vec<String>,
    },
    #[error("`{key}` is in another unit: the key is `{meant}`, in {unit}")]
    WrongUnit {
        key: String,
        meant: String,
        unit: &'static str,
        converted: Option<String>,
    },
    #[error("`{key}` belongs to {owner}, but this case has {chosen}")]
    OtherChoice {
        key: String,
        owner: String,
        chosen: String,
    },
    #[error("`{key}` must be {wanted}, this is {found}")]
    WrongType {
        key: String,
        wanted: String,
        found: &'static str,
    },
    #[error("`{key}` cannot be \"{word}\"")]
    UnknownWord {
        key: String,
        word: String,
        near: Option<String>,
        words: String,
    },
    #[error("`{key}` is {value}, outside its range")]
    OutOfRange {
        key: String,
        value: String,
        range: String,
    },
    #[error("{section} needs `{key}`")]
    MissingKey {
        key: String,
        section: String,
        wanted: String,
    },
    #[error("{section} has both `{first}` and `{second}`, which say the same thing twice")]
    Both {
        section: String,
        first: String,
        second: String,
    },
    #[error("{section} needs one of {keys}")]
    NoneOf { section: String, keys: String },
    #[error("`{key}` means nothing here: it needs {needs}")]
    Idle { key: String, needs: String },
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
pub(crate) enum FileReason {
    #[error("`{key}`: there is no file {}", path.display())]
    Missing { key: String, path: PathBuf },
    #[error("the file {} cannot be read: {why}", path.display())]
    Unreadable { path: PathBuf, why: String },
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
