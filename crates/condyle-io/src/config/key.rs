//! What is known of a key before any file is read.

use std::borrow::Cow;

use super::kind::Kind;
use super::limits::Limits;

/// What is known of a key before any file is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Name in the file, with the unit where it has one.
    pub name: &'static str,
    /// What it means.
    pub doc: Cow<'static, str>,
    /// What may be written.
    pub kind: Kind,
    /// What is taken where the file is silent.
    pub silent: WhereSilent,
    /// What a number may be.
    pub limits: Option<Limits>,
}

impl Key {
    /// The same where only some words can be written.
    pub(crate) fn of_words(self, words: Vec<&'static str>) -> Self {
        let kind = Kind::Word(words);
        Self { kind, ..self }
    }
}

/// What is taken where a file does not give a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WhereSilent {
    /// Nothing can be: the key must be given.
    MustBeGiven,
    /// Nothing: the value is left out.
    LeftOut,
    /// A value, as it would be written.
    Takes(String),
}

/// Names of keys.
pub(crate) fn names(keys: &[Key]) -> impl Iterator<Item = &'static str> + '_ {
    keys.iter().map(|key| key.name)
}
