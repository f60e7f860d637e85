//! Types of values that a file may have behind a key, read and written.

use condyle::parameter::unit_of;
use toml::Spanned;
use toml::de::DeValue;

use super::fault::{out_of_range, type_fault, unknown_word};
use super::key::{Key, Kind, number, quoted, type_name};
use super::problem::Log;

/// A type of value.
pub(crate) trait Setting: Sized {
    /// Its kind in messages, schema and book.
    fn kind() -> Kind;

    /// Reads the value, or reports why it cannot be used.
    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self>;

    /// Returns the value in TOML; `None` for a value that is omitted.
    fn text(&self) -> Option<String>;

    /// Writes the value with the meaning of its key; one that is omitted as a comment.
    fn write(&self, key: &Key, out: &mut Writer) {
        match self.text() {
            Some(text) => out.line(&format!("{} = {text}", key.name), &key.doc),
            None => out.line(&format!("# {} =", key.name), &key.doc),
        }
    }
}

/// Reads a number within the limits of its key, or reports why it cannot be used.
fn limited(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<f64> {
    let Some(number) = number(value.get_ref()) else {
        return wrong_type(value, key, log);
    };
    match key.limits {
        Some(limits) if !limits.allow(number) => {
            let unit = unit_of(key.name).map_or(String::new(), |unit| format!(" {unit}"));
            let (value_shown, range) = (format!("{number}{unit}"), format!("{limits}{unit}"));
            log.reject(value.span(), out_of_range(key.name, &value_shown, &range))
        }
        _ => Some(number),
    }
}

/// Declares types of values by kind, text, and reader; a reader that returns `None` for a value of another type has it
/// reported.
macro_rules! plain_values {
    ($( $ty:ty: $kind:ident, |$this:ident| $text:expr, |$value:ident| $read:expr; )+) => { $(
        impl Setting for $ty {
            fn kind() -> Kind {
                Kind::$kind
            }

            fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
                let $value = value.get_ref();
                let read = $read;
                read.or_else(|| wrong_type(value, key, log))
            }

            fn text(&self) -> Option<String> {
                let $this = self;
                Some($text)
            }
        }
    )+ };
}

plain_values! {
    bool: Truth, |this| this.to_string(), |value| value.as_bool();
    Sign: Sign, |this| format!("{:.0}", this.0), |value| {
        number(value).filter(|number| number.abs() == 1.0).map(Self)
    };
    String: Text, |this| quoted(this), |value| value.as_str().map(str::to_owned);
    Names: Names, |this| {
        let names: Vec<String> = this.0.iter().map(|name| quoted(name)).collect();
        format!("[{}]", names.join(", "))
    }, |value| {
        let name = |name: &Spanned<DeValue<'_>>| name.get_ref().as_str().map(str::to_owned);
        let names: Option<_> = value.as_array().and_then(|list| list.iter().map(name).collect());
        names.map(Self)
    };
    Levels: Levels, |this| {
        let levels: Vec<String> = this.0.iter().map(|level| match level {
            Level::Number(number) => format!("{number:?}"),
            Level::Word(word) => quoted(word),
        }).collect();
        format!("[{}]", levels.join(", "))
    }, |value| {
        let levels: Option<Vec<Level>> =
            value.as_array().and_then(|list| list.iter().map(|item| Level::of(item.get_ref())).collect());
        levels.filter(|levels| !levels.is_empty()).map(Self)
    };
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
            return wrong_type(value, key, log);
        }
        Some(number as Self)
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self}"))
    }
}

/// A list of numbers, each within the limits of its key.
impl<const N: usize> Setting for [f64; N] {
    fn kind() -> Kind {
        Kind::Numbers(N)
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let list = value.get_ref().as_array().filter(|list| list.len() == N);
        let Some(list) = list else {
            return wrong_type(value, key, log);
        };
        let numbers: Vec<Option<f64>> = list.iter().map(|item| limited(item, key, log)).collect();
        let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
        numbers?.try_into().ok()
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

    fn write(&self, key: &Key, out: &mut Writer) {
        match self {
            Some(value) => value.write(key, out),
            None => out.line(&format!("# {} =", key.name), &key.doc),
        }
    }
}

/// Returns whether `text` is a name that may become part of a file name or a column: small letters, digits and hyphens.
pub(crate) fn is_name(text: &str) -> bool {
    let is_part = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    !text.is_empty() && text.chars().all(is_part)
}

/// Reports a value whose type is not that of its key, and returns no value.
pub(crate) fn wrong_type<T>(
    value: &Spanned<DeValue<'_>>,
    key: &Key,
    log: &mut Log<'_>,
) -> Option<T> {
    let found = type_name(value.get_ref());
    let fault = type_fault(key.name, &key.kind.to_string(), found);
    log.reject(value.span(), fault)
}

pub(crate) fn read_word<'w>(
    value: &Spanned<DeValue<'_>>,
    key: &Key,
    words: &[&'w str],
    log: &mut Log<'_>,
) -> Option<&'w str> {
    let Some(written) = value.get_ref().as_str() else {
        return wrong_type(value, key, log);
    };
    let known = words.iter().find(|word| **word == written).copied();
    known.or_else(|| log.reject(value.span(), unknown_word(key.name, written, words)))
}

/// A factor of 1 or -1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sign(pub f64);

/// Names, such as those of columns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(pub Vec<String>);

/// One of several values that a key takes in turn.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// A number.
    Number(f64),
    /// A word, the name of a file, or true and false as words.
    Word(String),
}

impl Level {
    /// Returns the number; none for a word.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Word(_) => None,
        }
    }
}

/// Levels, one or more.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Levels(pub Vec<Level>);

impl Level {
    fn of(value: &DeValue<'_>) -> Option<Self> {
        if let Some(number) = number(value).filter(|number| number.is_finite()) {
            return Some(Self::Number(number));
        }
        let word = value
            .as_str()
            .filter(|word| !word.is_empty())
            .map(str::to_owned);
        let truth = || value.as_bool().map(|truth| truth.to_string());
        word.or_else(truth).map(Self::Word)
    }
}

/// Pairs of numbers, such as the points of a curve. Limits are not applied to them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points(pub Vec<(f64, f64)>);

impl Setting for Points {
    fn kind() -> Kind {
        Kind::Pairs
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let mut wrong = |value: &Spanned<DeValue<'_>>, wanted: &str| {
            let fault = type_fault(key.name, wanted, type_name(value.get_ref()));
            log.problem(value.span(), fault);
        };
        let Some(list) = value.get_ref().as_array() else {
            wrong(value, "a list of pairs, such as [[0.0, 1.0], [50.0, 2.0]]");
            return None;
        };
        let mut pairs = Vec::new();
        for item in list {
            let cells = item.get_ref().as_array().into_iter().flatten();
            let numbers: Vec<Option<f64>> = cells.map(|cell| number(cell.get_ref())).collect();
            match numbers[..] {
                [Some(first), Some(second)] => pairs.push((first, second)),
                _ => wrong(item, "made of pairs of numbers"),
            }
        }
        (pairs.len() == list.len()).then_some(Self(pairs))
    }

    fn text(&self) -> Option<String> {
        Some(format!("{:?}", self.0))
    }

    fn write(&self, key: &Key, out: &mut Writer) {
        out.comment(&key.doc);
        out.pairs(key.name, &self.0);
    }
}

/// Declares values that are one of a few words.
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
            /// Every choice.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The words of all choices.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// Returns the word of a file for this choice.
            pub fn word(self) -> &'static str {
                match self { $( Self::$variant => $word, )+ }
            }

            /// Describes the choice in one sentence.
            pub fn about(self) -> &'static str {
                match self { $( Self::$variant => concat!($($doc),+).trim(), )+ }
            }

            /// Returns the choice that `word` names.
            pub fn from_word(word: &str) -> Option<Self> {
                match word { $( $word => Some(Self::$variant), )+ _ => None }
            }
        }

        words! { $name { $($variant = $word,)+ } }
    )+ };
}

/// Declares the words of files for the variants of an enum.
macro_rules! words {
    ($( $name:ident { $($variant:ident = $word:literal,)+ } )+) => { $(
        impl Setting for $name {
            fn kind() -> Kind {
                Kind::Word(vec![$($word),+])
            }

            fn read(
                value: &toml::Spanned<toml::de::DeValue<'_>>, key: &Key, log: &mut Log<'_>,
            ) -> Option<Self> {
                match read_word(value, key, &[$($word),+], log)? {
                    $( $word => Some(Self::$variant), )+
                    _ => None,
                }
            }

            fn text(&self) -> Option<String> {
                Some(format!("{:?}", match self { $( Self::$variant => $word, )+ }))
            }
        }
    )+ };
}

pub(crate) use {choice, words};

/// Writes a file key by key, with the meaning of each key as a comment.
#[derive(Default)]
pub(crate) struct Writer {
    text: String,
    path: Vec<String>,
    /// Waveforms are written by their names rather than by their points.
    pub(crate) names_waveforms: bool,
}

/// Column at which comments start, if the value is short enough.
const COMMENT_COLUMN: usize = 40;

impl Writer {
    pub(crate) fn new(names_waveforms: bool) -> Self {
        Self {
            names_waveforms,
            ..Self::default()
        }
    }

    pub(crate) fn table(&mut self, name: &str, write: impl FnOnce(&mut Self)) {
        self.headed(name, ["[", "]"], write);
    }

    pub(crate) fn table_of_list(&mut self, name: &str, write: impl FnOnce(&mut Self)) {
        self.headed(name, ["[[", "]]"], write);
    }

    fn headed(&mut self, name: &str, [open, close]: [&str; 2], write: impl FnOnce(&mut Self)) {
        self.path.push(name.to_owned());
        let path = self.path.join(".");
        self.text.push_str(&format!("\n{open}{path}{close}\n"));
        write(self);
        self.path.pop();
    }

    pub(crate) fn comment(&mut self, text: &str) {
        self.text.push_str(&format!("# {text}\n"));
    }

    pub(crate) fn line(&mut self, assignment: &str, doc: &str) {
        let doc = doc.trim();
        let line = format!("{assignment:<COMMENT_COLUMN$} # {doc}\n");
        self.text.push_str(&line);
    }

    /// Writes pairs of numbers, a few on each line.
    pub(crate) fn pairs(&mut self, key: &str, pairs: &[(f64, f64)]) {
        const PAIRS_ON_A_LINE: usize = 4;
        self.text.push_str(&format!("{key} = [\n"));
        for some in pairs.chunks(PAIRS_ON_A_LINE) {
            let some: Vec<String> = some
                .iter()
                .map(|(a, b)| format!("[{a:?}, {b:?}]"))
                .collect();
            self.text.push_str(&format!("    {},\n", some.join(", ")));
        }
        self.text.push_str("]\n");
    }

    pub(crate) fn into_text(self) -> String {
        self.text
    }
}
