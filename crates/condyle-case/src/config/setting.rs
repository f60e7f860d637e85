//! Values that a key can take: read from a file, written to one.

use std::ops::Range;

use condyle::parameter::unit_of;
use toml::Spanned;
use toml::de::DeValue;

use super::key::{Key, Kind, number, quoted, quoted_list, type_name};
use super::log::Log;
use super::reason::KeyReason;
use super::suggest::nearest;

/// A value that stands behind a key.
pub trait Setting: Sized {
    /// What may be written.
    fn kind() -> Kind;

    /// The value, or nothing and the reason in `log`.
    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self>;

    /// The value as a file has it; nothing for a value that is left out.
    fn text(&self) -> Option<String>;
}

/// A number inside the limits of its key, or the reason in `log`.
fn limited(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<f64> {
    let Some(number) = number(value.get_ref()) else {
        wrong_type(value, key, log);
        return None;
    };
    match key.limits {
        Some(limits) if !limits.allow(number) => {
            let unit = unit_of(key.name).map_or(String::new(), |unit| format!(" {unit}"));
            let reason = KeyReason::OutOfRange {
                key: key.name.to_owned(),
                value: format!("{number}{unit}"),
                range: format!("{limits}{unit}"),
            };
            log.problem(value.span(), reason);
            None
        }
        _ => Some(number),
    }
}

impl Setting for f64 {
    fn kind() -> Kind {
        Kind::Number
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        limited(value, key, log)
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

impl Setting for u64 {
    fn kind() -> Kind {
        Kind::WholeNumber
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let number = limited(value, key, log)?;
        if number.fract() != 0.0 {
            wrong_type(value, key, log);
            return None;
        }
        Some(number as Self)
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self}"))
    }
}

impl Setting for bool {
    fn kind() -> Kind {
        Kind::Truth
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let read = value.get_ref().as_bool();
        if read.is_none() {
            wrong_type(value, key, log);
        }
        read
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self}"))
    }
}

impl Setting for String {
    fn kind() -> Kind {
        Kind::Text
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let read = value.get_ref().as_str().map(str::to_owned);
        if read.is_none() {
            wrong_type(value, key, log);
        }
        read
    }

    fn text(&self) -> Option<String> {
        Some(quoted(self))
    }
}

impl Setting for [f64; 2] {
    fn kind() -> Kind {
        Kind::TwoNumbers
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let list = value.get_ref().as_array();
        let pair: Vec<_> = list.into_iter().flatten().collect();
        let [first, second] = pair[..] else {
            wrong_type(value, key, log);
            return None;
        };
        let (first, second) = (limited(first, key, log), limited(second, key, log));
        Some([first?, second?])
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

impl<T: Setting> Setting for Option<T> {
    fn kind() -> Kind {
        T::kind()
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        T::read(value, key, log).map(Some)
    }

    fn text(&self) -> Option<String> {
        self.as_ref().and_then(T::text)
    }
}

impl Setting for [f64; 3] {
    fn kind() -> Kind {
        Kind::ThreeNumbers
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let list: Vec<_> = value.get_ref().as_array().into_iter().flatten().collect();
        let numbers: Vec<f64> = list
            .iter()
            .filter_map(|value| number(value.get_ref()))
            .filter(|value| key.limits.is_none_or(|limits| limits.allow(*value)))
            .collect();
        let three = numbers.try_into().ok().filter(|_| list.len() == 3);
        if three.is_none() {
            wrong_type(value, key, log);
        }
        three
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

/// Reports that `value` is not what `key` takes.
pub(crate) fn wrong_type(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) {
    let reason = KeyReason::WrongType {
        key: key.name.to_owned(),
        wanted: key.kind.to_string(),
        found: type_name(value.get_ref()),
    };
    log.problem(value.span(), reason);
}

/// The one of `words` that `value` is, or the reason in `log`.
pub(crate) fn read_word<'w>(
    value: &Spanned<DeValue<'_>>,
    key: &Key,
    words: &[&'w str],
    log: &mut Log<'_>,
) -> Option<&'w str> {
    let Some(written) = value.get_ref().as_str() else {
        wrong_type(value, key, log);
        return None;
    };
    let known = words.iter().find(|word| **word == written);
    if known.is_none() {
        let reason = KeyReason::UnknownWord {
            key: key.name.to_owned(),
            word: written.to_owned(),
            near: nearest(written, words.iter().copied()),
            words: quoted_list(words),
        };
        log.problem(value.span(), reason);
    }
    known.copied()
}

/// Names, such as those of columns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(pub Vec<String>);

impl Setting for Names {
    fn kind() -> Kind {
        Kind::Names
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let list = value.get_ref().as_array();
        let names = list.and_then(|list| {
            let name = |name: &Spanned<DeValue<'_>>| name.get_ref().as_str().map(str::to_owned);
            list.iter().map(name).collect()
        });
        if names.is_none() {
            wrong_type(value, key, log);
        }
        names.map(Self)
    }

    fn text(&self) -> Option<String> {
        let names: Vec<String> = self.0.iter().map(|name| quoted(name)).collect();
        Some(format!("[{}]", names.join(", ")))
    }
}

/// One of several values that a key takes in turn.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A number.
    Number(f64),
    /// A word, the name of a file, or true and false as words.
    Word(String),
}

/// Levels, one or more.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Levels(pub Vec<Level>);

impl Level {
    fn of(value: &Spanned<DeValue<'_>>) -> Option<Self> {
        let value = value.get_ref();
        let word = || {
            value
                .as_str()
                .filter(|word| !word.is_empty())
                .map(str::to_owned)
        };
        let truth = || value.as_bool().map(|truth| truth.to_string());
        let as_number = number(value).filter(|number| number.is_finite());
        as_number
            .map(Self::Number)
            .or_else(|| word().or_else(truth).map(Self::Word))
    }

    fn text(&self) -> String {
        match self {
            Self::Number(number) => format!("{number:?}"),
            Self::Word(word) => quoted(word),
        }
    }
}

impl Setting for Levels {
    fn kind() -> Kind {
        Kind::Levels
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let list = value.get_ref().as_array();
        let levels: Option<Vec<Level>> = list.and_then(|list| list.iter().map(Level::of).collect());
        let levels = levels.filter(|levels| !levels.is_empty());
        if levels.is_none() {
            wrong_type(value, key, log);
        }
        levels.map(Self)
    }

    fn text(&self) -> Option<String> {
        let levels: Vec<String> = self.0.iter().map(Level::text).collect();
        Some(format!("[{}]", levels.join(", ")))
    }
}

/// A pair of numbers and where it stands.
pub(crate) type PlacedPair = ([f64; 2], Range<usize>);

/// A list of pairs of numbers with their places, or everything in it that is none.
pub(crate) fn pairs(
    value: &Spanned<DeValue<'_>>,
    key: &str,
    log: &mut Log<'_>,
) -> Option<Vec<PlacedPair>> {
    let mut wrong = |value: &Spanned<DeValue<'_>>, wanted: &str| {
        let reason = KeyReason::WrongType {
            key: key.to_owned(),
            wanted: wanted.to_owned(),
            found: type_name(value.get_ref()),
        };
        log.problem(value.span(), reason);
    };
    let Some(list) = value.get_ref().as_array() else {
        wrong(value, "a list of pairs, such as [[0.0, 1.0], [50.0, 2.0]]");
        return None;
    };
    let mut pairs = Vec::new();
    for item in list {
        match pair(item.get_ref()) {
            Some(pair) => pairs.push((pair, item.span())),
            None => wrong(item, "made of pairs of numbers"),
        }
    }
    (pairs.len() == list.len()).then_some(pairs)
}

/// A list of two numbers.
fn pair(value: &DeValue<'_>) -> Option<[f64; 2]> {
    let cells = value.as_array()?.iter();
    let numbers: Option<Vec<f64>> = cells.map(|cell| number(cell.get_ref())).collect();
    numbers?.try_into().ok()
}

/// Declares a value that is one of a few words.
macro_rules! choice {
    ($(
        $(#[doc = $about:literal])+
        $name:ident {
            $( $(#[doc = $doc:literal])+ $variant:ident = $word:literal, )+
        }
    )+) => { $(
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $( $(#[doc = $doc])+ $variant, )+
        }

        impl $name {
            /// Every one of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Every word a file may use.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The word a file uses for it.
            pub fn word(self) -> &'static str {
                match self { $( Self::$variant => $word, )+ }
            }

            /// What it is, in one sentence.
            pub fn about(self) -> &'static str {
                match self { $( Self::$variant => concat!($($doc),+).trim(), )+ }
            }

            /// The choice that `word` stands for.
            pub fn from_word(word: &str) -> Option<Self> {
                match word { $( $word => Some(Self::$variant), )+ _ => None }
            }
        }

        impl $crate::config::setting::Setting for $name {
            fn kind() -> $crate::config::key::Kind {
                $crate::config::key::Kind::Word(Self::WORDS.to_vec())
            }

            fn read(
                value: &toml::Spanned<toml::de::DeValue<'_>>,
                key: &$crate::config::key::Key,
                log: &mut $crate::config::log::Log<'_>,
            ) -> Option<Self> {
                let word = $crate::config::setting::read_word(value, key, Self::WORDS, log)?;
                Self::from_word(word)
            }

            fn text(&self) -> Option<String> {
                Some(format!("{:?}", self.word()))
            }
        }
    )+ };
}

pub(crate) use choice;
