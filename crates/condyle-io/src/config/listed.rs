//! Values that are lists of any length.

use toml::Spanned;
use toml::de::DeValue;

use super::key::Key;
use super::kind::Kind;
use super::log::Log;
use super::setting::Setting;
use super::value::{number, quoted};
use super::words::wrong_type;

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
