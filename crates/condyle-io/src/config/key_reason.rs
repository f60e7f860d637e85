//! What is wrong with keys and their values.

use thiserror::Error;

use super::reason::Reason;

/// Why a key or its value cannot be used.
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
            Self::OtherChoice { owner, .. } => Some(format!("remove the key, or write `{owner}`")),
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

/// What most often ails a line that is not TOML.
const SYNTAX_ADVICE: &str = "a line is `key = value`: text in quotes, a number without its unit, \
    a list in square brackets; a key stands once in its table";
