//! Tables whose keys are declared once: name with the unit, default, range, meaning.
//!
//! The struct, its reader, its writer and the page of the book all come from one declaration made
//! with [`settings!`].

use super::key::{Key, names};
use super::log::Log;
use super::section::Section;
use super::writer::Writer;

/// A part of a file whose keys are declared once.
pub trait Settings: Sized {
    /// Its keys, in the order they are written.
    fn keys() -> Vec<Key>;

    /// Reads every key of `section`; nothing where one is wrong, with the reason in `log`.
    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self>;

    /// Writes every key with its value.
    fn write(&self, out: &mut Writer);
}

/// Reads the table `name` of `above`, which holds nothing but the keys of `S`.
pub(crate) fn read_table<S: Settings>(
    above: &Section<'_>,
    name: &str,
    log: &mut Log<'_>,
) -> Option<S> {
    let section = above.table(name, log);
    let known: Vec<&str> = names(&S::keys()).collect();
    section.check_keys(&known, log);
    S::read(&section, log)
}

/// Declares a part of a file: a struct, and its [`Settings`].
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

        impl $crate::config::settings::Settings for $name {
            fn keys() -> Vec<$crate::config::key::Key> {
                vec![$(
                    $crate::config::key::Key {
                        name: stringify!($field),
                        doc: concat!($($doc),+).trim().into(),
                        kind: <$ty as $crate::config::setting::Setting>::kind(),
                        silent: $crate::config::settings::where_silent!($ty $(, $default)?),
                        limits: $crate::config::settings::given!($($limits)?),
                    },
                )*]
            }

            fn read(
                section: &$crate::config::section::Section<'_>,
                log: &mut $crate::config::log::Log<'_>,
            ) -> Option<Self> {
                let mut keys = Self::keys().into_iter();
                $(
                    let $field: Option<$ty> = section.setting(
                        &keys.next()?,
                        $crate::config::settings::given!($($default)?),
                        log,
                    );
                )*
                Some(Self { $( $field: $field?, )* })
            }

            fn write(&self, out: &mut $crate::config::writer::Writer) {
                let mut keys = Self::keys().into_iter();
                $(
                    if let Some(key) = keys.next() {
                        out.setting(&key, &self.$field);
                    }
                )*
            }
        }
    )+ };
}

/// What is taken where the file is silent.
macro_rules! where_silent {
    ($ty:ty) => {
        $crate::config::key::WhereSilent::MustBeGiven
    };
    ($ty:ty, $default:expr) => {
        match <$ty as $crate::config::setting::Setting>::text(&$default) {
            Some(text) => $crate::config::key::WhereSilent::Takes(text),
            None => $crate::config::key::WhereSilent::LeftOut,
        }
    };
}

/// What a declaration gives, if it gives it.
macro_rules! given {
    () => {
        None
    };
    ($given:expr) => {
        Some($given)
    };
}

pub(crate) use {given, settings, where_silent};
