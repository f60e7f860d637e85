//! Keys of a case by their names.

use condyle::parameter::split_unit;
use thiserror::Error;

use super::contents::Case;
use crate::config::nearest;

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

/// Why a key or a value cannot stand in for one of a case.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum OverrideError {
    /// A name that is not that of one number.
    #[error(transparent)]
    Name(#[from] KeyNameError),
    /// Updates of a march that finds them itself.
    #[error(
        "the march of this case finds its updates itself, since it has update = \"auto\"; refine what it goes by, such as \
         depth_tolerance_fraction=0.1,0.03,0.01, or write update = \"fixed\""
    )]
    UpdatesAreFound,
    /// A value that is no number.
    #[error("`{text}` is no value for `{path}`; write a number, such as 10 or 0.5")]
    NotNumber {
        /// The key.
        path: String,
        /// As written.
        text: String,
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

/// A number that a case has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberKey {
    /// Dotted path, such as `march.updates`.
    pub path: String,
    /// Whether it counts something, rather than measuring it.
    pub is_whole: bool,
}

impl Case {
    /// Every number of the case, defaults too, in the order they are written.
    pub fn number_keys(&self) -> Vec<NumberKey> {
        let keys = self.keys().into_iter();
        keys.filter_map(NumberKey::of).collect()
    }

    /// The dotted path of the number that `written` means: a dotted path as it is, or the name of
    /// a key, with or without its unit.
    ///
    /// # Errors
    /// A name that no number has, or several.
    pub fn path_of_number(&self, written: &str) -> Result<String, OverrideError> {
        if written.contains('.') {
            return Ok(written.to_owned());
        }
        let paths: Vec<String> = self.number_keys().into_iter().map(|key| key.path).collect();
        let near = |names: &[&str]| nearest(written, names.iter().copied());
        path_called("number", written, &paths, near).map_err(|error| match error {
            KeyNameError::Unknown { name, .. } if name == "updates" => {
                OverrideError::UpdatesAreFound
            }
            error => error.into(),
        })
    }

    /// Whether the number at the dotted `path` counts something.
    pub fn is_whole_number(&self, path: &str) -> bool {
        let keys = self.number_keys();
        keys.iter().any(|key| key.path == path && key.is_whole)
    }
}

impl NumberKey {
    /// That of a key; none where its value is no number.
    fn of((path, value): (String, toml::Value)) -> Option<Self> {
        let is_whole = value.is_integer();
        (is_whole || value.is_float()).then_some(Self { path, is_whole })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn updates_that_a_march_finds_itself_are_no_number() {
        let text = "[march]\nupdate = \"auto\"\n";
        let case = Case::parse(text, "case.toml", Path::new("")).expect("it is a case");
        let error = case.path_of_number("updates").unwrap_err();
        assert_eq!(error, OverrideError::UpdatesAreFound);
        let said = error.to_string();
        assert!(said.contains("update = \"auto\"") && said.contains("depth_tolerance_fraction"));
    }

    #[test]
    fn names_of_numbers_are_found_with_and_without_unit() {
        let case = Case::parse("", "case.toml", Path::new("")).expect("all have defaults");
        let path = |written| case.path_of_number(written).map_err(|e| e.to_string());
        assert_eq!(path("updates").as_deref(), Ok("march.updates"));
        assert_eq!(
            path("slip_tolerance").as_deref(),
            Ok("contact.slip_tolerance_mm_per_s")
        );
        assert_eq!(path("edge_mm").as_deref(), Ok("insert.edge_mm"));
        assert_eq!(path("what.ever").as_deref(), Ok("what.ever"));
        assert!(case.is_whole_number("march.updates") && !case.is_whole_number("insert.edge_mm"));
        assert_eq!(
            path("updatse").unwrap_err(),
            "the case has no number called `updatse`; did you mean `updates`?"
        );
        assert!(path("xyz").unwrap_err().contains("such as `march.updates`"));
        let many = path("spacing_mm").unwrap_err();
        assert!(
            many.ends_with("write `femur.spacing_mm` or `insert.spacing_mm`"),
            "{many}"
        );
    }
}
