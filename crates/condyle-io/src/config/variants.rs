//! Parts of a file that are one of several, by the word of one key, each declared once.

use super::choices::Choices;
use super::key::Key;
use super::log::Log;
use super::section::Section;
use super::writer::Writer;

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
            fn choices() -> $crate::config::choices::Choices {
                $crate::config::choices::Choices::new(
                    stringify!($key),
                    concat!($($key_doc),+).trim(),
                    $default,
                    vec![$(
                        $crate::config::choices::Offered {
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
