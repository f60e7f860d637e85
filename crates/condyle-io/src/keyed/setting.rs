//! Values a key can take: read from a file, written to one.

use toml::Spanned;
use toml::de::DeValue;

use super::Sign;
use super::keys::{Key, unit_of};
use super::parse::Log;
use super::problems::Reason;
use super::unknown::nearest;

/// A value that stands behind a key.
pub trait Setting: Sized {
    /// What may be written, in words: "a number".
    fn kind() -> String;

    /// The value, or nothing and the reason in `log`.
    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self>;

    /// The value as a file has it; nothing for a value that is left out.
    fn text(&self) -> Option<String>;
}

/// Words in quotes with commas between: `"a", "b" or "c"`.
pub(crate) fn quoted_list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// Reports that `value` is not what `key` takes.
pub(crate) fn wrong_type(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) {
    let reason = Reason::WrongType {
        key: key.name.to_owned(),
        wanted: (key.kind)(),
        found: type_name(value.get_ref()),
    };
    log.problem(value.span(), reason);
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

/// One of `words`, as written, or the reason in `log`.
pub(crate) fn read_word<'a>(
    value: &'a Spanned<DeValue<'_>>,
    key: &Key,
    words: &[&str],
    log: &mut Log<'_>,
) -> Option<&'a str> {
    let Some(word) = value.get_ref().as_str() else {
        wrong_type(value, key, log);
        return None;
    };
    if words.contains(&word) {
        return Some(word);
    }
    let reason = Reason::UnknownWord {
        key: key.name.to_owned(),
        word: word.to_owned(),
        near: nearest(word, words.iter().copied()),
        words: quoted_list(words),
    };
    log.problem(value.span(), reason);
    None
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
            let reason = Reason::OutOfRange {
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
    fn kind() -> String {
        "a number".to_owned()
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        limited(value, key, log)
    }

    fn text(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

impl Setting for u64 {
    fn kind() -> String {
        "a whole number".to_owned()
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
    fn kind() -> String {
        "true or false".to_owned()
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
    fn kind() -> String {
        "text in quotes".to_owned()
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

/// A basic string of TOML.
pub(crate) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

impl Setting for [f64; 2] {
    fn kind() -> String {
        "a list of two numbers".to_owned()
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
    fn kind() -> String {
        T::kind()
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        T::read(value, key, log).map(Some)
    }

    fn text(&self) -> Option<String> {
        self.as_ref().and_then(T::text)
    }
}

impl Setting for Sign {
    fn kind() -> String {
        "1 or -1".to_owned()
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        match number(value.get_ref()) {
            Some(1.0) => Some(Self::Plus),
            Some(-1.0) => Some(Self::Minus),
            _ => {
                wrong_type(value, key, log);
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(format!("{:.0}", self.factor()))
    }
}
