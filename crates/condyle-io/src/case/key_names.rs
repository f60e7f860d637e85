//! Which key of a case a name is that of.

use thiserror::Error;

use super::contents::Case;
use crate::config::split_unit;

/// Why a name is that of no one key.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum KeyNameError {
    /// Nothing is called so.
    #[error(
        "the case has no {what} called `{name}`; {}",
        match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => "give its dotted path, such as `march.updates`".to_owned(),
        }
    )]
    Unknown {
        /// What was looked for, such as "number".
        what: &'static str,
        /// As written.
        name: String,
        /// One that is likely to be meant.
        near: Option<String>,
    },
    /// Several are called so.
    #[error("the case has more than one {what} called `{name}`; write `{}`", paths.join("` or `"))]
    Many {
        /// What was looked for.
        what: &'static str,
        /// As written.
        name: String,
        /// Their dotted paths.
        paths: Vec<String>,
    },
}

impl Case {
    /// The dotted path of every key with its value, defaults too, in the order they are written.
    pub(super) fn keys(&self) -> Vec<(String, toml::Value)> {
        let mut keys = Vec::new();
        add_keys(self.to_toml().parse().unwrap_or_default(), "", &mut keys);
        keys
    }
}

impl Case {
    /// The number at the dotted `path`, defaults too; none where the case has no such number.
    pub fn number_at(&self, path: &str) -> Option<f64> {
        match self.value_at(path)? {
            toml::Value::Float(number) => Some(number),
            toml::Value::Integer(number) => Some(number as f64),
            _ => None,
        }
    }

    /// The number at the dotted `path` as the case has it; of what is done to a waveform, which a case has done already, as
    /// its file says it, or nothing done.
    pub fn number_at_or_written(&self, path: &str) -> Option<f64> {
        let of_silence = || match leaf(path) {
            "scale" => Some(1.0),
            "offset" => Some(0.0),
            _ => None,
        };
        let written = || {
            let mut keys = Vec::new();
            add_keys(self.origin.source.inner().parse().ok()?, "", &mut keys);
            let (_, value) = keys.into_iter().find(|(key, _)| key == path)?;
            value
                .as_float()
                .or_else(|| Some(value.as_integer()? as f64))
        };
        let number = self.number_at(path).or_else(written);
        number.or_else(of_silence)
    }

    /// The word at the dotted `path`, defaults too; none where the case has no such word.
    pub fn word_at(&self, path: &str) -> Option<String> {
        self.value_at(path)?.as_str().map(str::to_owned)
    }

    /// Whether the case has a key or a table at the dotted `path`, defaults too.
    pub fn has(&self, path: &str) -> bool {
        let below = |key: &str| key.strip_prefix(path).is_some_and(is_end_or_dot);
        self.keys().iter().any(|(key, _)| below(key))
    }

    fn value_at(&self, path: &str) -> Option<toml::Value> {
        let mut keys = self.keys().into_iter();
        keys.find_map(|(key, value)| (key == path).then_some(value))
    }
}

fn is_end_or_dot(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with('.')
}

fn add_keys(table: toml::Table, above: &str, keys: &mut Vec<(String, toml::Value)>) {
    for (name, value) in table {
        let path = match above {
            "" => name,
            above => format!("{above}.{name}"),
        };
        match value {
            toml::Value::Table(inside) => add_keys(inside, &path, keys),
            toml::Value::Array(list) if list.iter().all(toml::Value::is_table) => {
                for table in list {
                    add_keys_of_list(table, &path, keys);
                }
            }
            value => keys.push((path, value)),
        }
    }
}

/// Those of a table of a list, which is known by its name: `activity.stairs.share`.
fn add_keys_of_list(table: toml::Value, list: &str, keys: &mut Vec<(String, toml::Value)>) {
    if let toml::Value::Table(table) = table
        && let Some(name) = table.get("name").and_then(toml::Value::as_str)
    {
        let path = format!("{list}.{name}");
        add_keys(table, &path, keys);
    }
}

/// The one of `paths` whose last word is `name`, with or without its unit; `what` they are, and which of their
/// last words is near to a name that none has, is for the message.
pub(super) fn path_called(
    what: &'static str,
    name: &str,
    paths: &[String],
    near: impl FnOnce(&[&str]) -> Option<String>,
) -> Result<String, KeyNameError> {
    let is_meant = |path: &&String| leaf(path) == name || split_unit(leaf(path)).0 == name;
    let meant: Vec<String> = paths.iter().filter(is_meant).cloned().collect();
    let name = name.to_owned();
    match <[String; 1]>::try_from(meant) {
        Ok([path]) => Ok(path),
        Err(meant) if meant.is_empty() => {
            let leaves: Vec<&str> = paths.iter().map(|path| leaf(path)).collect();
            let near = near(&leaves);
            Err(KeyNameError::Unknown { what, name, near })
        }
        Err(paths) => Err(KeyNameError::Many { what, name, paths }),
    }
}

/// The last word of a dotted path.
fn leaf(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}
