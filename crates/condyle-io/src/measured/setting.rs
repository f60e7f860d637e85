//! Values that only a file of measured data has.

use toml::Spanned;
use toml::de::DeValue;

use crate::case::keys::Key;
use crate::case::parse::Log;
use crate::case::setting::{Setting, number, quoted, wrong_type};

/// Names of columns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(pub Vec<String>);

impl Setting for Names {
    fn kind() -> String {
        "a list of names in quotes".to_owned()
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

impl Setting for [f64; 3] {
    fn kind() -> String {
        "a list of three numbers".to_owned()
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
