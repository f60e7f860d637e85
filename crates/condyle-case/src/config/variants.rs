//! Keys whose word decides which other keys a table has, such as `shape`.

use std::borrow::Cow;

use super::key::{Key, Kind, WhereSilent, names};
use super::log::Log;
use super::reason::KeyReason;
use super::section::Section;
use super::setting::read_word;
use super::writer::Writer;

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

/// A part of a file that is one of several, by the word of one key.
pub trait Variants: Sized {
    /// The key that chooses, the words it can be, and the keys that each brings.
    fn choices() -> Choices;

    /// The word for this one.
    fn word(&self) -> &'static str;

    /// Reads the one that `word` means, from the keys that it brings.
    fn read_as(word: &str, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self>;

    /// Writes the keys that its word brings.
    fn write_keys(&self, out: &mut Writer);

    /// Reads the key that chooses and the keys it brings; reports every key that is neither of
    /// these nor `common` to all words.
    fn read(section: &Section<'_>, common: &[Key], log: &mut Log<'_>) -> Option<Self> {
        let word = Self::choices().read(section, common, log)?;
        Self::read_as(word, section, log)
    }

    /// Writes the key that chooses and the keys it brings.
    fn write(&self, out: &mut Writer) {
        out.word(&Self::choices().by, self.word());
        self.write_keys(out);
    }
}

/// Declares a part of a file that is one of several: an enum, and its [`Variants`].
///
/// `key = "default word" { Variant(Keys) = "word", }` where `Keys` are
/// [`Settings`](super::settings::Settings), or left out where a word brings no keys.
macro_rules! variants {
    ($(
        $(#[doc = $about:literal])+
        $name:ident by
        $(#[doc = $key_doc:literal])+
        $key:ident = $default:literal {
            $( $(#[doc = $doc:literal])+ $variant:ident $(($keys:ty))? = $word:literal, )+
        }
    )+) => { $(
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {
            $( $(#[doc = $doc])+ $variant $(($keys))?, )+
        }

        impl $crate::config::variants::Variants for $name {
            fn choices() -> $crate::config::variants::Choices {
                $crate::config::variants::Choices::new(
                    stringify!($key),
                    concat!($($key_doc),+).trim(),
                    $default,
                    vec![$(
                        $crate::config::variants::Offered {
                            word: $word,
                            keys: $crate::config::variants::keys_of!($($keys)?),
                        },
                    )+],
                )
            }

            fn word(&self) -> &'static str {
                match self { $( Self::$variant { .. } => $word, )+ }
            }

            fn read_as(
                word: &str,
                section: &$crate::config::section::Section<'_>,
                log: &mut $crate::config::log::Log<'_>,
            ) -> Option<Self> {
                Some(match word {
                    $( $word => Self::$variant
                        $((<$keys as $crate::config::settings::Settings>::read(section, log)?))?, )+
                    _ => return None,
                })
            }

            fn write_keys(&self, out: &mut $crate::config::writer::Writer) {
                match self {
                    $( Self::$variant $(($crate::config::variants::bound!(keys, $keys)))? => {
                        $( <$keys as $crate::config::settings::Settings>::write(keys, out); )?
                    } )+
                }
            }
        }
    )+ };
}

/// The keys that a word brings; none where it brings no settings.
macro_rules! keys_of {
    () => {
        Vec::new()
    };
    ($keys:ty) => {
        <$keys as $crate::config::settings::Settings>::keys()
    };
}

/// A name for what a variant holds, where it holds something.
macro_rules! bound {
    ($name:ident, $keys:ty) => {
        $name
    };
}

pub(crate) use {bound, keys_of, variants};
