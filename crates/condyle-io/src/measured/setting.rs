//! Values that only a file of measured data has.

use toml::Spanned;
use toml::de::DeValue;

use crate::keyed::{Key, Kind, Log, Setting, quoted, wrong_type};

/// Names of columns.
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
