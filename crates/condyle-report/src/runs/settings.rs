//! What two cases set otherwise.

use std::collections::BTreeMap;

use serde::Serialize;
use toml::{Table, Value};

/// A key that two cases set otherwise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SettingDifference {
    /// Its dotted path.
    pub key: String,
    /// What the first case says; none where it does not.
    pub first: Option<String>,
    /// What the second says.
    pub second: Option<String>,
}

/// Keys that two cases set otherwise, in alphabetical order; cases are written with every default.
pub(super) fn settings(first: &str, second: &str) -> Vec<SettingDifference> {
    let [first, second] = [first, second].map(flattened);
    let mut keys: Vec<&String> = first.keys().chain(second.keys()).collect();
    keys.sort_unstable();
    keys.dedup();
    let differ = keys
        .into_iter()
        .filter(|key| first.get(*key) != second.get(*key));
    differ
        .map(|key| SettingDifference {
            key: key.clone(),
            first: first.get(key).cloned(),
            second: second.get(key).cloned(),
        })
        .collect()
}

fn flattened(case: &str) -> BTreeMap<String, String> {
    let mut values = BTreeMap::new();
    if let Ok(table) = case.parse::<Table>() {
        flatten("", &Value::Table(table), &mut values);
    }
    values
}

fn flatten(path: &str, value: &Value, into: &mut BTreeMap<String, String>) {
    let below = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match value {
        Value::Table(table) => {
            for (key, value) in table {
                flatten(&below(key), value, into);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_differ_are_told_by_their_path() {
        let first = "[contact]\nfriction = 0.04\nlaw = \"linear\"\n[[activity]]\nname = \"gait\"\n";
        let second = "[contact]\nfriction = 0.06\nlaw = \"linear\"\n[[activity]]\nname = \"stairs\"\nshare = 1\n";
        let told = settings(first, second);
        let keys: Vec<&str> = told.iter().map(|told| told.key.as_str()).collect();
        assert_eq!(
            keys,
            ["activity[0].name", "activity[0].share", "contact.friction"]
        );
        assert_eq!(told[1].first, None);
        assert_eq!(told[2].second.as_deref(), Some("0.06"));
    }
}
