//! One declaration of every key: its name with the unit, its default, its range, its meaning.
//!
//! The structs a case is made of, their reader, their writer and the page of the book all come
//! from the declarations made with [`settings!`] and [`choice!`].

use std::fmt;

use super::parse::{Log, Section};
use super::to_toml::Writer;

/// What is known of a key before any file is read.
#[derive(Clone, Debug)]
pub struct Key {
    /// Name in the file, with the unit where it has one.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
    /// What may be written, in words.
    pub kind: fn() -> String,
    /// The value taken where the file is silent, as it would be written; none where it must be given.
    pub default: Option<fn() -> Option<String>>,
    /// What a number may be.
    pub limits: Option<Limits>,
}

/// The least and the most that a number may be, both allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least.
    pub least: f64,
    /// Most.
    pub most: f64,
}

/// Limits from `least` to `most`, both allowed.
pub(crate) const fn within(least: f64, most: f64) -> Limits {
    Limits { least, most }
}

impl Limits {
    /// Whether `value` lies inside; NaN does not.
    pub fn allow(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", plain(self.least), plain(self.most))
    }
}

/// A number as a person would write it.
pub(crate) fn plain(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// A part of a case whose keys are declared once.
pub trait Settings: Sized {
    /// Its keys, in the order they are written.
    const KEYS: &'static [Key];

    /// Reads every key of `section`; nothing where one is wrong, with the reason in `log`.
    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self>;

    /// Writes every key with its value.
    fn write(&self, out: &mut Writer);
}

/// Every unit that ends a name, with how a person writes it.
const UNITS: &[(&str, &str)] = &[
    ("_mg_per_mm3", "mg/mm3"),
    ("_mm3_per_nm", "mm3/(N m)"),
    ("_nm_s_per_rad", "N m s/rad"),
    ("_n_s_per_mm", "N s/mm"),
    ("_mm_per_s", "mm/s"),
    ("_n_per_mm", "N/mm"),
    ("_kg_m2", "kg m2"),
    ("_mpa", "MPa"),
    ("_deg", "degrees"),
    ("_kg", "kg"),
    ("_hz", "Hz"),
    ("_nm", "N m"),
    ("_mm", "mm"),
    ("_n", "N"),
    ("_s", "s"),
];

/// A key's name without its unit, and the unit in words.
pub(crate) fn split_unit(name: &str) -> (&str, Option<&'static str>) {
    UNITS
        .iter()
        .find_map(|&(suffix, unit)| Some((name.strip_suffix(suffix)?, Some(unit))))
        .unwrap_or((name, None))
}

/// The unit that `name` ends in, in words.
pub fn unit_of(name: &str) -> Option<&'static str> {
    split_unit(name).1
}

/// Declares a part of a case: a struct, and its [`Settings`].
///
/// `name: Type = default, in limits;` where the default is left out the key must be given.
macro_rules! settings {
    ($(
        $(#[doc = $about:literal])+
        $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $field:ident : $ty:ty $(= $default:expr)? $(, in $limits:expr)? ;
            )*
        }
    )+) => { $(
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name {
            $( $(#[doc = $doc])+ pub $field: $ty, )*
        }

        impl $crate::case::keys::Settings for $name {
            const KEYS: &'static [$crate::case::keys::Key] = &[$(
                $crate::case::keys::Key {
                    name: stringify!($field),
                    doc: concat!($($doc),+),
                    kind: <$ty as $crate::case::setting::Setting>::kind,
                    default: $crate::case::keys::default_text!($ty $(, $default)?),
                    limits: $crate::case::keys::limits_of!($($limits)?),
                },
            )*];

            fn read(
                section: &$crate::case::parse::Section<'_>,
                log: &mut $crate::case::parse::Log<'_>,
            ) -> Option<Self> {
                let mut keys = Self::KEYS.iter();
                $(
                    let $field: Option<$ty> = section.setting(
                        keys.next()?,
                        $crate::case::keys::default_value!($($default)?),
                        log,
                    );
                )*
                Some(Self { $( $field: $field?, )* })
            }

            fn write(&self, out: &mut $crate::case::to_toml::Writer) {
                let mut keys = Self::KEYS.iter();
                $(
                    if let Some(key) = keys.next() {
                        out.setting(key, &self.$field);
                    }
                )*
            }
        }
    )+ };
}

/// The default of a key as text, made when it is asked for.
macro_rules! default_text {
    ($ty:ty) => {
        None
    };
    ($ty:ty, $default:expr) => {
        Some(|| <$ty as $crate::case::setting::Setting>::text(&$default))
    };
}

/// The default of a key, if it has one.
macro_rules! default_value {
    () => {
        None
    };
    ($default:expr) => {
        Some($default)
    };
}

/// The limits of a key, if it has any.
macro_rules! limits_of {
    () => {
        None
    };
    ($limits:expr) => {
        Some($limits)
    };
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
            /// Every word a file may use.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The word a file uses for it.
            pub fn word(self) -> &'static str {
                match self { $( Self::$variant => $word, )+ }
            }

            /// The choice that `word` stands for.
            pub fn from_word(word: &str) -> Option<Self> {
                match word { $( $word => Some(Self::$variant), )+ _ => None }
            }
        }

        impl $crate::case::setting::Setting for $name {
            fn kind() -> String {
                $crate::case::setting::quoted_list(Self::WORDS)
            }

            fn read(
                value: &toml::Spanned<toml::de::DeValue<'_>>,
                key: &$crate::case::keys::Key,
                log: &mut $crate::case::parse::Log<'_>,
            ) -> Option<Self> {
                let word = $crate::case::setting::read_word(value, key, Self::WORDS, log)?;
                Self::from_word(word)
            }

            fn text(&self) -> Option<String> {
                Some(format!("{:?}", self.word()))
            }
        }
    )+ };
}

pub(crate) use {choice, default_text, default_value, limits_of, settings};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_unit_wins() {
        assert_eq!(unit_of("slip_tolerance_mm_per_s"), Some("mm/s"));
        assert_eq!(unit_of("posterior_n_per_mm"), Some("N/mm"));
        assert_eq!(split_unit("edge_mm"), ("edge", Some("mm")));
        assert_eq!(split_unit("layers"), ("layers", None));
    }

    #[test]
    fn limits_allow_their_ends_and_no_nan() {
        let limits = within(0.0, 0.499);
        assert!(limits.allow(0.0) && limits.allow(0.499));
        assert!(!limits.allow(0.5) && !limits.allow(f64::NAN));
        assert_eq!(limits.to_string(), "0 to 0.499");
    }
}
