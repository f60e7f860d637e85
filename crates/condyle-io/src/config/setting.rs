//! Values a key can take: read from a file, written to one.

use toml::Spanned;
use toml::de::DeValue;

use super::key::Key;
use super::key_reason::KeyReason;
use super::kind::Kind;
use super::log::Log;
use super::unit::unit_of;
use super::value::{number, quoted};
use super::words::wrong_type;

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
