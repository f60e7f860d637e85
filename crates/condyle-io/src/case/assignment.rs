//! Any value of a case set from outside, before the case is read.

use std::fmt;

use thiserror::Error;
use toml_edit::Value;

use super::contents::Case;
use super::key_names::{KeyNameError, path_called};
use super::overriding::with_value;
use crate::config::{Problems, likeliest};

/// A value to be taken in place of the one that the case file gives, or leaves out.
#[derive(Clone, Debug)]
pub struct Assignment {
    key: String,
    text: String,
}

/// Why a value of a case cannot be set from outside.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AssignmentError {
    /// Not written as a key with a value.
    #[error("`{written}` is no key with a value; write them as `march.updates=5`")]
    NotKeyAndValue {
        /// As written.
        written: String,
    },
    /// A name that is not that of one key.
    #[error(transparent)]
    Name(#[from] KeyNameError),
}

/// Why a case cannot be read with values set from outside.
#[derive(Clone, Debug, Error)]
pub enum ChangeError {
    /// What is wrong with the case, as it is or changed.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A value that cannot be set.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
}

impl Assignment {
    /// The one written as `key=value`: the key a dotted path, or the last word of one, with or
    /// without its unit; the value as in a case, but a word needs no quotes.
    ///
    /// # Errors
    /// A text without a key or without a value.
    pub fn parse(written: &str) -> Result<Self, AssignmentError> {
        let (key, text) = written.split_once('=').unwrap_or_default();
        let (key, text) = (key.trim().to_owned(), text.trim().to_owned());
        if key.is_empty() || text.is_empty() {
            let written = written.to_owned();
            return Err(AssignmentError::NotKeyAndValue { written });
        }
        Ok(Self { key, text })
    }

    /// The one that gives `key` a value, written as in a case, but a word needs no quotes.
    pub fn of(key: &str, text: String) -> Self {
        let key = key.to_owned();
        Self { key, text }
    }

    /// Whether its key is a dotted path, which says where it stands without a look at the case.
    pub(super) fn is_placed(&self) -> bool {
        self.key.contains('.')
    }

    /// The dotted path of its key, once it is placed.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    /// The same with the dotted path of its key in `case`.
    pub(super) fn placed_in(&self, case: &Case) -> Result<Self, AssignmentError> {
        let key = case.path_of_key(&self.key)?;
        let text = self.text.clone();
        Ok(Self { key, text })
    }

    /// The text of a case with this value in it; a text that is not TOML stays as it is.
    pub(super) fn applied_to(&self, case: &str) -> String {
        let value = self.text.parse::<Value>();
        with_value(
            case,
            &self.key,
            value.unwrap_or_else(|_| self.text.as_str().into()),
        )
    }

    /// The key and the value, as messages name them.
    pub(super) fn in_words(&self) -> String {
        format!("{} = {}", self.key, self.text)
    }
}

impl Case {
    /// The dotted path of the key that `written` names: a dotted path as it is, or the last word of one, with or without
    /// its unit.
    pub(crate) fn path_of_key(&self, written: &str) -> Result<String, KeyNameError> {
        if written.contains('.') {
            return Ok(written.to_owned());
        }
        let paths: Vec<String> = self.keys().into_iter().map(|(path, _)| path).collect();
        let near = |names: &[&str]| likeliest(written, names);
        path_called("key", written, &paths, near)
    }
}

impl fmt::Display for Assignment {
    /// As [`Assignment::parse`] reads it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.text)
    }
}
