//! Keys: what is known of one before any file is read, and values of TOML in words.

use std::borrow::Cow;
use std::fmt;

use toml::de::DeValue;

/// What is known of a key before any file is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Name in the file, with the unit where it has one.
    pub name: &'static str,
    /// What it means.
    pub doc: Cow<'static, str>,
    /// What may be written.
    pub kind: Kind,
    /// What is taken where the file is silent.
    pub silent: WhereSilent,
    /// What a number may be.
    pub limits: Option<Limits>,
}

impl Key {
    /// The same where only some words can be written.
    pub(crate) fn of_words(self, words: Vec<&'static str>) -> Self {
        let kind = Kind::Word(words);
        Self { kind, ..self }
    }
}

/// What is taken where a file does not give a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WhereSilent {
    /// Nothing can be: the key must be given.
    MustBeGiven,
    /// Nothing: the value is left out.
    LeftOut,
    /// A value, as it would be written.
    Takes(String),
}

/// Names of keys.
pub(crate) fn names(keys: &[Key]) -> impl Iterator<Item = &'static str> + '_ {
    keys.iter().map(|key| key.name)
}

/// What may be written behind a key; its `Display` says it in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A number without a fraction.
    WholeNumber,
    /// 1 or -1.
    Sign,
    /// True or false.
    Truth,
    /// Any text.
    Text,
    /// Where a file is.
    Path,
    /// One of a few words.
    Word(Vec<&'static str>),
    /// Three words, each one of a few.
    ThreeWords(&'static [&'static str]),
    /// Any names.
    Names,
    /// Numbers or words, one or more.
    Levels,
    /// Two numbers.
    TwoNumbers,
    /// Three numbers.
    ThreeNumbers,
    /// Any number of pairs of numbers.
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
            Self::TwoNumbers => f.write_str("a list of two numbers"),
            Self::ThreeNumbers => f.write_str("a list of three numbers"),
            Self::Pairs => f.write_str("a list of pairs of numbers"),
        }
    }
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

/// Words in quotes with commas between: `"a", "b" or "c"`.
pub(crate) fn quoted_list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// What a value is, in words.
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

/// A float or an integer as a number; none for anything else.
pub(crate) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().replace('_', "").parse().ok(),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|whole| whole as f64),
        _ => None,
    }
}

/// A basic string of TOML.
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
