//! The numbers that a case has, and how they are called.

use super::contents::Case;
use super::overriding::OverrideError;
use crate::keyed::{nearest, split_unit};

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
        let mut keys = Vec::new();
        let written: toml::Table = self.to_toml().parse().unwrap_or_default();
        add_numbers(&written, "", &mut keys);
        keys
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
        let keys = self.number_keys();
        let is_meant = |key: &&NumberKey| is_called(leaf(&key.path), written);
        let paths: Vec<String> = keys
            .iter()
            .filter(is_meant)
            .map(|key| key.path.clone())
            .collect();
        let key = written.to_owned();
        match <[String; 1]>::try_from(paths) {
            Ok([path]) => Ok(path),
            Err(paths) if paths.is_empty() && key == "updates" => {
                Err(OverrideError::UpdatesAreFound)
            }
            Err(paths) if paths.is_empty() => {
                let near = nearest(written, keys.iter().map(|key| leaf(&key.path)));
                Err(OverrideError::UnknownKey { key, near })
            }
            Err(paths) => Err(OverrideError::ManyKeys { key, paths }),
        }
    }

    /// Whether the number at the dotted `path` counts something.
    pub fn is_whole_number(&self, path: &str) -> bool {
        let keys = self.number_keys();
        keys.iter().any(|key| key.path == path && key.is_whole)
    }
}

/// The last word of a dotted path.
pub(super) fn leaf(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Whether `written` is the name of a key, with or without its unit.
pub(super) fn is_called(name: &str, written: &str) -> bool {
    name == written || split_unit(name).0 == written
}

fn add_numbers(table: &toml::Table, above: &str, keys: &mut Vec<NumberKey>) {
    for (name, value) in table {
        let path = match above {
            "" => name.clone(),
            above => format!("{above}.{name}"),
        };
        match value {
            toml::Value::Table(inside) => add_numbers(inside, &path, keys),
            toml::Value::Integer(_) | toml::Value::Float(_) => keys.push(NumberKey {
                is_whole: value.is_integer(),
                path,
            }),
            _ => {}
        }
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
