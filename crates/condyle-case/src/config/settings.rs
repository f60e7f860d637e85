//! Tables and choices that are declared once: the struct or enum, its reader, its writer and its description.

use super::items::{Item, TableItem, check, keys};
use super::key::Key;
use super::problem::Log;
use super::section::Section;
use super::setting::Writer;

/// A part of a file that is declared once.
pub(crate) trait Settings: Sized {
    /// Its entries, in the order they are written.
    fn items() -> Vec<Item>;

    /// Reads the part from the table that has its keys; reports what is wrong with their values.
    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self>;

    fn write(&self, out: &mut Writer);

    /// Returns the keys of the part itself, without those of tables inside.
    fn keys() -> Vec<Key> {
        keys(&Self::items()).into_iter().cloned().collect()
    }

    fn item(name: &'static str, about: &str) -> Item {
        Item::Table(TableItem::new(name, about, Self::items()))
    }

    fn read_in(above: &Section<'_>, name: &'static str, log: &mut Log<'_>) -> Option<Self> {
        Self::read(&above.table(name, log), log)
    }

    fn write_in(&self, name: &str, out: &mut Writer) {
        out.table(name, |out| self.write(out));
    }

    /// Reads the parts of the list `name`; returns none if one of them has a problem.
    fn read_list(above: &Section<'_>, name: &str, log: &mut Log<'_>) -> Option<Vec<Self>> {
        let all = above.read_list(name, log, Self::read)?;
        above.check_names_differ(name, log)?;
        Some(all)
    }

    /// Reads the part from `section`, and reports every key that it does not have.
    fn read_checked(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        check(section, &Self::items(), log);
        Self::read(section, log)
    }
}

/// A list of tables, each headed `[[name]]`.
impl<T: Settings> Settings for Vec<T> {
    fn items() -> Vec<Item> {
        T::items()
    }

    fn item(name: &'static str, about: &str) -> Item {
        Item::Table(TableItem {
            is_list: true,
            ..TableItem::new(name, about, T::items())
        })
    }

    /// Reads the only part of `section`.
    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        Some(vec![T::read(section, log)?])
    }

    fn read_in(above: &Section<'_>, name: &'static str, log: &mut Log<'_>) -> Option<Self> {
        T::read_list(above, name, log)
    }

    fn write(&self, out: &mut Writer) {
        self.iter().for_each(|part| part.write(out));
    }

    fn write_in(&self, name: &str, out: &mut Writer) {
        for part in self {
            out.table_of_list(name, |out| part.write(out));
        }
    }
}

/// Declares parts of a file, each a struct with [`Settings`] by [`settings_of!`].
macro_rules! settings {
    ($(
        $(#[doc = $about:literal])+
        $name:ident $([$check:ident])? {
            $(
                $(#[doc = $doc:literal])+
                $([$($how:tt)+])? $field:ident : $ty:ty $(= $default:expr)? $(, in $limits:expr)? ;
            )*
        }
    )+) => { $(
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name {
            $( $(#[doc = $doc])+ pub $field: $ty, )*
        }

        settings_of! {
            $name $([$check])? {
                $( $(#[doc = $doc])+ $([$($how)+])? $field: $ty $(= $default)? $(, in $limits)?; )*
            }
        }
    )+ };
}

/// Declares [`Settings`] of structs that are declared elsewhere, where the items of `config` are imported.
///
/// `key: Type = default, in limits;` declares a key, which must be given if there is no default; `[flat] part: Type;` the
/// entries of another part in the same table; `[table] part: Type;` a table inside, called like the field or as in
/// `[table "name"]`. After `Name [method]`, `method(&self, section, log)` checks values against each other.
macro_rules! settings_of {
    ($(
        $name:ident $([$check:ident])? {
            $(
                $(#[doc = $doc:literal])+
                $([$($how:tt)+])? $field:ident : $ty:ty $(= $default:expr)? $(, in $limits:expr)? ;
            )*
        }
    )+) => { $(
        impl Settings for $name {
            fn items() -> Vec<Item> {
                [$( entry!(
                    items [$($($how)+)?] $field $ty, [concat!($($doc),+)] [$($default)?] [$($limits)?]
                ) ),*].concat()
            }

            fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
                $( let $field: Option<$ty> = entry!(
                    read section log [$($($how)+)?] $field $ty, [concat!($($doc),+)] [$($default)?] [$($limits)?]
                ); )*
                let read = Self { $( $field: $field?, )* };
                $( read.$check(section, log); )?
                Some(read)
            }

            fn write(&self, out: &mut Writer) {
                $( entry!(
                    write (&self.$field) out [$($($how)+)?] $field $ty, [concat!($($doc),+)] [$($default)?] [$($limits)?]
                ); )*
            }
        }
    )+ };
}

/// Describes, reads or writes one entry of [`settings_of!`].
macro_rules! entry {
    (items [] $field:ident $ty:ty, $($rest:tt)*) => {
        vec![Item::Key(key!($field $ty, $($rest)*))]
    };
    (items [flat] $field:ident $ty:ty, $($rest:tt)*) => {
        <$ty as Settings>::items()
    };
    (items [table $($name:literal)?] $field:ident $ty:ty, [$doc:expr] $($rest:tt)*) => {
        vec![<$ty as Settings>::item(name!($field $($name)?), $doc)]
    };
    (read $section:ident $log:ident [] $field:ident $ty:ty, [$doc:expr] [$($default:expr)?] [$($limits:expr)?]) => {
        $section.setting(
            &key!($field $ty, [$doc] [$($default)?] [$($limits)?]),
            given!($($default)?),
            $log,
        )
    };
    (read $section:ident $log:ident [flat] $field:ident $ty:ty, $($rest:tt)*) => {
        <$ty as Settings>::read($section, $log)
    };
    (read $section:ident $log:ident [table $($name:literal)?] $field:ident $ty:ty, $($rest:tt)*) => {
        <$ty as Settings>::read_in($section, name!($field $($name)?), $log)
    };
    (write ($value:expr) $out:ident [] $field:ident $ty:ty, $($rest:tt)*) => {
        Setting::write($value, &key!($field $ty, $($rest)*), $out)
    };
    (write ($value:expr) $out:ident [flat] $($rest:tt)*) => {
        Settings::write($value, $out)
    };
    (write ($value:expr) $out:ident [table $($name:literal)?] $field:ident $($rest:tt)*) => {
        Settings::write_in($value, name!($field $($name)?), $out)
    };
}

macro_rules! key {
    ($field:ident $ty:ty, [$doc:expr] [$($default:expr)?] [$($limits:expr)?]) => {
        Key {
            name: stringify!($field),
            doc: $doc.trim().into(),
            kind: <$ty as Setting>::kind(),
            silent: where_silent!($ty, $($default)?),
            limits: given!($($limits)?),
        }
    };
}

macro_rules! where_silent {
    ($ty:ty,) => {
        WhereSilent::MustBeGiven
    };
    ($ty:ty, $default:expr) => {
        match <$ty as Setting>::text(&$default) {
            Some(text) => WhereSilent::Takes(text),
            None => WhereSilent::LeftOut,
        }
    };
}

macro_rules! given {
    () => {
        None
    };
    ($given:expr) => {
        Some($given)
    };
}

macro_rules! name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $name:literal) => {
        $name
    };
}

/// Declares parts of a file that are one of several by the word of a key, each an enum with [`Settings`].
///
/// `key = "default word" { Variant(Part) = "word", }`, where the entries of `Part` follow in the same table; with
/// `Variant(@table Part)` they are those of a table called like the word. A word without entries has no `Part`.
macro_rules! variants {
    ($(
        $(#[doc = $about:literal])+
        $name:ident by
        $(#[doc = $key_doc:literal])+
        $key:ident = $default:literal {
            $( $(#[doc = $doc:literal])+ $variant:ident $(($(@$how:ident)? $part:ty))? = $word:literal, )+
        }
    )+) => { $(
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {
            $( $(#[doc = $doc])+ $variant $(($part))?, )+
        }

        impl $name {
            pub(crate) fn choices() -> Choices {
                Choices::new(
                    stringify!($key),
                    concat!($($key_doc),+),
                    $default,
                    vec![$(
                        Offered {
                            word: $word,
                            items: offer!(items $word [concat!($($doc),+)] $([$($how)?] $part)?),
                        },
                    )+],
                )
            }

            /// Returns the word of a file for this choice.
            pub fn word(&self) -> &'static str {
                match self { $( Self::$variant { .. } => $word, )+ }
            }

                    pub(crate) fn read_as(word: &str, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
                Some(match word {
                    $( $word => Self::$variant
                        $((offer!(read section log [$($how)?] $word $part)?))?, )+
                    _ => return None,
                })
            }
        }

        impl Settings for $name {
            fn items() -> Vec<Item> {
                vec![Item::Choice(Self::choices())]
            }

            fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
                let word = Self::choices().read(section, log)?;
                Self::read_as(word, section, log)
            }

            fn write(&self, out: &mut Writer) {
                let by = Self::choices().by;
                out.line(&format!("{} = {:?}", by.name, self.word()), &by.doc);
                match self {
                    $( Self::$variant $((bound!(part, $part)))? => {
                        $( offer!(write part out [$($how)?] $word $part); )?
                    } )+
                }
            }
        }
    )+ };
}

/// Describes, reads or writes what a word of [`variants!`] brings.
macro_rules! offer {
    (items $word:literal [$doc:expr]) => {
        Vec::new()
    };
    (items $word:literal [$doc:expr] [] $part:ty) => {
        <$part as Settings>::items()
    };
    (items $word:literal [$doc:expr] [table] $part:ty) => {
        vec![<$part as Settings>::item($word, $doc)]
    };
    (read $section:ident $log:ident [] $word:literal $part:ty) => {
        <$part as Settings>::read($section, $log)
    };
    (read $section:ident $log:ident [table] $word:literal $part:ty) => {
        <$part as Settings>::read_in($section, $word, $log)
    };
    (write $value:ident $out:ident [] $word:literal $part:ty) => {
        Settings::write($value, $out)
    };
    (write $value:ident $out:ident [table] $word:literal $part:ty) => {
        Settings::write_in($value, $word, $out)
    };
}

/// A name for what a variant holds, if it holds something.
macro_rules! bound {
    ($name:ident, $part:ty) => {
        $name
    };
}

pub(crate) use {
    bound, entry, given, key, name, offer, settings, settings_of, variants, where_silent,
};
