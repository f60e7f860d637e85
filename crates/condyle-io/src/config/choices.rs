//! Keys whose word decides which other keys a table has, such as `shape`.

use std::borrow::Cow;

use super::key::{Key, WhereSilent, names};
use super::key_reason::KeyReason;
use super::kind::Kind;
use super::log::Log;
use super::section::Section;
use super::words::read_word;

/// A key whose word decides which other keys a table has.
#[derive(Clone, Debug)]
pub struct Choices {
    /// The key that chooses.
    pub by: Key,
    /// Each word and what it brings, in the order of the page.
    pub offered: Vec<Offered>,
    /// The word taken where the file gives none.
    pub default: &'static str,
}

/// A word, and the keys that a table has under it.
#[derive(Clone, Debug)]
pub struct Offered {
    /// The word.
    pub word: &'static str,
    /// Its keys, in the order they are written.
    pub keys: Vec<Key>,
}

impl Choices {
    /// The choice by the key `name` between what is `offered`, of which `default` is one.
    pub(crate) fn new(
        name: &'static str,
        doc: impl Into<Cow<'static, str>>,
        default: &'static str,
        offered: Vec<Offered>,
    ) -> Self {
        let words: Vec<&'static str> = offered.iter().map(|offer| offer.word).collect();
        debug_assert!(words.contains(&default), "{name} offers its default");
        let by = Key {
            name,
            doc: doc.into(),
            kind: Kind::Word(words),
            silent: WhereSilent::Takes(format!("{default:?}")),
            limits: None,
        };
        Self {
            by,
            offered,
            default,
        }
    }

    /// The word that `section` gives; reports keys that are neither `common` to all words nor of
    /// this one.
    pub(crate) fn read(
        &self,
        section: &Section<'_>,
        common: &[Key],
        log: &mut Log<'_>,
    ) -> Option<&'static str> {
        let word = match section.value(self.by.name) {
            Some(value) => read_word(value, &self.by, &self.words(), log)?,
            None => self.default,
        };
        self.check_keys(word, section, common, log);
        Some(word)
    }

    fn words(&self) -> Vec<&'static str> {
        self.offered.iter().map(|offer| offer.word).collect()
    }

    /// Reports keys that no table has under `word`; one that it has under another word is said to
    /// belong there.
    fn check_keys(&self, word: &str, section: &Section<'_>, common: &[Key], log: &mut Log<'_>) {
        let own = self.offered.iter().filter(|offer| offer.word == word);
        let known: Vec<&str> = names(common)
            .chain([self.by.name])
            .chain(own.flat_map(|offer| names(&offer.keys)))
            .collect();
        for (key, value) in section.other_keys(&known) {
            let name: &str = key.get_ref();
            let reason = match self.owner_of(name) {
                Some(owner) => KeyReason::OtherChoice {
                    key: name.to_owned(),
                    owner: self.assignment(owner),
                    chosen: self.assignment(word),
                },
                None => section.unknown(name, value, &known),
            };
            log.problem(key.span(), reason);
        }
    }

    /// Reports keys that only other words than `word` bring.
    pub(crate) fn check_keys_of_others(
        &self,
        word: &str,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) {
        let own = self.offered.iter().filter(|offer| offer.word == word);
        let known: Vec<&str> = own.flat_map(|offer| names(&offer.keys)).collect();
        for (key, _) in section.other_keys(&known) {
            let name: &str = key.get_ref();
            if let Some(owner) = self.owner_of(name) {
                let reason = KeyReason::OtherChoice {
                    key: name.to_owned(),
                    owner: self.assignment(owner),
                    chosen: self.assignment(word),
                };
                log.problem(key.span(), reason);
            }
        }
    }

    fn owner_of(&self, name: &str) -> Option<&'static str> {
        let has = |offer: &&Offered| names(&offer.keys).any(|key| key == name);
        self.offered.iter().find(has).map(|offer| offer.word)
    }

    fn assignment(&self, word: &str) -> String {
        format!("{} = \"{word}\"", self.by.name)
    }
}
