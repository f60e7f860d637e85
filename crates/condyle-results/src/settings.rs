//! Keys in which two cases differ.

use std::collections::BTreeMap;

use serde::Serialize;
use toml::Value;

/// A key with different values in two cases.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SettingDifference {
    /// The dotted path of the key.
    pub key: String,
    /// Its value in the first case; none if it is absent.
    pub first: Option<String>,
    /// Its value in the second case; none if it is absent.
    pub second: Option<String>,
}

/// Number of points of a curve up to which they are shown.
const MAX_POINTS_SHOWN: usize = 4;

impl SettingDifference {
    /// Returns both values for a reader, a curve of many points by their number.
    pub fn shown(&self) -> [Option<String>; 2] {
        [&self.first, &self.second].map(|value| {
            let value = value.as_ref()?;
            let points = value.matches("], [").count() + 1;
            Some(match points > MAX_POINTS_SHOWN {
                true => format!("{points} points"),
                false => value.clone(),
            })
        })
    }
}

/// Returns the keys with different values, in alphabetical order; cases are written with every default.
pub fn setting_differences(first: &str, second: &str) -> Vec<SettingDifference> {
    let [first, second] = [first, second].map(|case| {
        let mut values = BTreeMap::new();
        flatten(
            "",
            &Value::Table(case.parse().unwrap_or_default()),
            &mut values,
        );
        values
    });
    let mut keys: Vec<&String> = first.keys().chain(second.keys()).collect();
    keys.sort_unstable();
    keys.dedup();
    keys.retain(|key| first.get(*key) != second.get(*key));
    let difference = |key: &String| SettingDifference {
        key: key.clone(),
        first: first.get(key).cloned(),
        second: second.get(key).cloned(),
    };
    keys.into_iter().map(difference).collect()
}

fn flatten(path: &str, value: &Value, into: &mut BTreeMap<String, String>) {
    match value {
        Value::Table(table) => {
            for (key, value) in table {
                let below = format!("{path}.{key}");
                flatten(below.trim_start_matches('.'), value, into);
            }
        }
        Value::Array(items) if items.iter().any(Value::is_table) => {
            for (index, item) in items.iter().enumerate() {
                flatten(&format!("{path}[{index}]"), item, into);
            }
        }
        plain => {
            into.insert(path.to_owned(), plain.to_string());
        }
    }
}
