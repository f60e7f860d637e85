//! Declared keys, their units, and values of TOML in words.

use std::borrow::Cow;
use std::fmt;

use condyle::parameter::Parameter;
use toml::de::DeValue;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    /// Name in the file, which ends in the unit of a quantity.
    pub name: &'static str,
    pub doc: Cow<'static, str>,
    pub kind: Kind,
    pub silent: WhereSilent,
    pub limits: Option<Limits>,
}

impl Key {
    pub fn number(
        name: &'static str,
        doc: impl Into<Cow<'static, str>>,
        default: f64,
        limits: Limits,
    ) -> Self {
        Self {
            name,
            doc: doc.into(),
            kind: Kind::Number,
            silent: WhereSilent::Takes(format!("{default:?}")),
            limits: Some(limits),
        }
    }

    /// Declares a key that may be omitted.
    pub fn optional(name: &'static str, doc: impl Into<Cow<'static, str>>, kind: Kind) -> Self {
        Self {
            name,
            doc: doc.into(),
            kind,
            silent: WhereSilent::LeftOut,
            limits: None,
        }
    }
}

/// The default of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum WhereSilent {
    /// None: the key must be given.
    MustBeGiven,
    /// No value.
    LeftOut,
    /// A value, in TOML.
    Takes(String),
}

pub(crate) fn names(keys: &[Key]) -> impl Iterator<Item = &'static str> + '_ {
    keys.iter().map(|key| key.name)
}

/// The type of a value; `Display` describes it in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Number,
    WholeNumber,
    /// 1 or -1.
    Sign,
    Truth,
    Text,
    Path,
    Word(Vec<&'static str>),
    /// Three words, each one of a few.
    ThreeWords(&'static [&'static str]),
    Names,
    /// Numbers or words, one or more.
    Levels,
    Numbers(usize),
    Pairs,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number => f.write_str("a number"),
            Self::WholeNumber => f.write_str("a whole number"),
            Self::Sign => f.write_str("1 or -1"),
            Self::Truth => f.write_str("true or false"),
            Self::Text => f.write_str("text in quotes"),
            Self::Path => f.write_str("a path in quotes"),
            Self::Word(words) => f.write_str(&quoted_list(words)),
            Self::ThreeWords(words) => write!(f, "three words of {}", quoted_list(words)),
            Self::Names => f.write_str("a list of names in quotes"),
            Self::Levels => f.write_str("a list of numbers or of words in quotes"),
            Self::Numbers(2) => f.write_str("a list of two numbers"),
            Self::Numbers(3) => f.write_str("a list of three numbers"),
            Self::Numbers(count) => write!(f, "a list of {count} numbers"),
            Self::Pairs => f.write_str("a list of pairs of numbers"),
        }
    }
}

/// An interval that includes its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Lower end.
    pub least: f64,
    /// Upper end.
    pub most: f64,
}

pub(crate) const fn within(least: f64, most: f64) -> Limits {
    Limits { least, most }
}

pub(crate) const fn limits_of(parameter: &Parameter) -> Limits {
    within(parameter.least, parameter.most)
}

impl Limits {
    /// Returns true if `value` lies inside; NaN does not.
    pub fn allow(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", plain(self.least), plain(self.most))
    }
}

/// Formats a number as a person would write it.
pub(crate) fn plain(value: f64) -> String {
    // Outside this range the zeros are hard to count.
    if value != 0.0 && !(1e-3..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Formats words as `"a", "b" or "c"`.
pub(crate) fn quoted_list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

pub(crate) fn type_name(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "text in quotes",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// Returns a float or an integer as a number.
pub(crate) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().replace('_', "").parse().ok(),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|whole| whole as f64),
        _ => None,
    }
}

/// Formats text as a string of TOML.
pub(crate) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_allow_their_ends_and_no_nan() {
        let limits = within(0.0, 0.499);
        assert!(limits.allow(0.0) && limits.allow(0.499));
        assert!(!limits.allow(0.5) && !limits.allow(f64::NAN));
        assert_eq!(limits.to_string(), "0 to 0.499");
    }
}
