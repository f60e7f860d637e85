//! The numbers that a case has, and how they are called.

use super::contents::Case;
use super::key_names::{KeyNameError, path_called};
use super::overriding::OverrideError;
use crate::config::nearest;

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
