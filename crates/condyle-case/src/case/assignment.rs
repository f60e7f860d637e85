//! Values set from outside, which replace those of a case file.

use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use condyle::machine::knee::KNEE;
use condyle::parameter::split_unit;
use thiserror::Error;
use toml::de::{DeTable, DeValue};

use super::build::BuildWarning;
use super::contents::Case;
use super::machine::Preset;
use super::renamed::current_path;
use super::run_options::Update;
use crate::config::*;

/// A value that replaces the one that a case file gives, or its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    key: String,
    text: String,
}

/// A key or value that cannot be set from outside: cause and remedy in words.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct AssignmentError(String);

/// A case that cannot be read with values set from outside.
#[derive(Clone, Debug, Error)]
pub enum ChangeError {
    /// Problems of the case, before or after the changes.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A value that cannot be set.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
}

impl Assignment {
    /// Parses `key=value`: the key is a dotted path, or its last word with or without the unit; the value is written as in
    /// a case, but a word needs no quotes.
    ///
    /// # Errors
    /// The key or the value is missing.
    pub fn parse(written: &str) -> Result<Self, AssignmentError> {
        let (key, text) = written.split_once('=').unwrap_or_default();
        let (key, text) = (key.trim(), text.trim());
        if key.is_empty() || text.is_empty() {
            return Err(AssignmentError(format!(
                "`{written}` is not of the form key=value; write it as `march.updates=5`"
            )));
        }
        Ok(Self::new(key, text))
    }

    /// Sets `key` to a value written as in a case, but a word needs no quotes.
    pub fn new(key: &str, text: impl Into<String>) -> Self {
        let (key, text) = (current_path(key), text.into());
        Self { key, text }
    }

    /// Sets the key at the dotted path `key` to the number written as `text`.
    ///
    /// # Errors
    /// The text is not a finite number. Whether the key exists and the number is in its range is checked when a case
    /// is read.
    pub fn number(key: &str, text: &str) -> Result<Self, AssignmentError> {
        let assignment = Self::new(key, text.trim());
        match assignment.as_number() {
            Some(_) => Ok(assignment),
            None => Err(AssignmentError(format!(
                "`{}` is not a valid value of `{key}`; write a number, such as 10 or 0.5",
                assignment.text
            ))),
        }
    }

    /// Returns the key: a dotted path, or its last word.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Returns the value as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the value as a finite number, in the unit of the key's name.
    pub fn as_number(&self) -> Option<f64> {
        let value = DeValue::parse(&self.text).ok()?;
        number(value.get_ref()).filter(|number| number.is_finite())
    }

    /// Returns whether the value is a table with a value at `path` within, such as `.scale`.
    pub(crate) fn has(&self, path: &str) -> bool {
        let value = toml::from_str::<toml::Value>(&format!("x = {}", self.text)).ok();
        let keys = format!("x{path}");
        let found = value
            .as_ref()
            .and_then(|value| keys.split('.').try_fold(value, |at, key| at.get(key)));
        path.starts_with('.') && found.is_some()
    }

    fn value(&self) -> String {
        match DeValue::parse(&self.text) {
            Ok(_) => self.text.clone(),
            Err(_) => quoted(&self.text),
        }
    }

    pub(super) fn line(&self) -> String {
        format!("{} = {}", self.key, self.value())
    }

    /// Returns the assignment with the dotted path of its key, if a single key has its name, for any words of the choices of a case.
    pub(super) fn placed(&self, items: &[Item]) -> Self {
        let mut paths = BTreeSet::new();
        add_paths(items, "", &mut paths);
        paths.retain(|path| is_called(path, &self.key));
        match (paths.pop_first(), paths.is_empty()) {
            (Some(path), true) if !path.contains(OF_LIST) => Self::new(&path, self.text()),
            _ => self.clone(),
        }
    }
}

/// The place in a path of the name of a table of a list.
const OF_LIST: &str = "*.";

/// Adds the dotted paths of all keys of `items`, for every word of their choices.
fn add_paths(items: &[Item], above: &str, paths: &mut BTreeSet<String>) {
    for item in items {
        match item {
            Item::Table(table) => {
                let of_list = if table.is_list { OF_LIST } else { "" };
                add_paths(
                    &table.items,
                    &format!("{above}{}.{of_list}", table.name),
                    paths,
                );
            }
            Item::Choice(choices) => {
                paths.insert(format!("{above}{}", choices.by.name));
                let offered = choices.offered.iter();
                offered.for_each(|offer| add_paths(&offer.items, above, paths));
            }
            Item::Key(key) => {
                paths.insert(format!("{above}{}", key.name));
            }
            Item::OneOf(_) | Item::AtMostOne(_) | Item::Needs(..) => {}
        }
    }
}

impl fmt::Display for Assignment {
    /// Writes the form that [`Assignment::parse`] reads.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.text)
    }
}

/// Values to be set in a document, as lines below the text of the file: problems with a value are shown at its line.
pub(super) struct Lines<'c> {
    changes: &'c [Assignment],
    /// For each change, a text that is blank up to the value.
    padded: Vec<(Range<usize>, String)>,
    pub shown: String,
}

impl<'c> Lines<'c> {
    pub fn new(file: &Source, changes: &'c [Assignment]) -> Self {
        let mut shown = file.inner().clone();
        let mut padded = Vec::new();
        for change in changes {
            if !shown.ends_with('\n') {
                shown.push('\n');
            }
            let start = shown.len();
            let key = start..start + change.key.len();
            // Blanks move the value to its place in the shown text: its problems then point there without a conversion.
            let blanks = " ".repeat(key.end - 1);
            padded.push((key, format!("{blanks}x = {}", change.value())));
            shown.push_str(&change.line());
        }
        Self {
            changes,
            padded,
            shown,
        }
    }

    pub fn apply<'a>(&'a self, document: &mut DeTable<'a>) {
        for (change, (place, text)) in self.changes.iter().zip(&self.padded) {
            let parsed = DeTable::parse(text).ok();
            let value = parsed.and_then(|parsed| parsed.into_inner().remove("x"));
            if let Some(value) = value {
                set_value(document, &change.key, place.clone(), value);
            }
        }
    }

    /// Removes the keys that would contradict those that are set, unless they are set too. Of a choice: those that do not apply to the
    /// new word, and those with another default for it, since a case that writes all keys has the constants of the word before. Of a
    /// curve: its other sources.
    pub fn leave_out(&self, document: &mut DeTable<'_>, items: &[Item]) -> Vec<BuildWarning> {
        let mut notes = Vec::new();
        for (place, change) in self.changes.iter().enumerate() {
            // The last value of a key counts.
            let mut later = self.changes[place + 1..].iter();
            if later.any(|later| later.key == change.key) {
                continue;
            }
            let (above, name) = change.key.rsplit_once('.').unwrap_or(("", &change.key));
            for item in items_at(items, above) {
                notes.extend(match item {
                    Item::Choice(choices) if choices.by.name == name => {
                        self.leave_out_choice(document, choices, change, above)
                    }
                    Item::OneOf(ways) | Item::AtMostOne(ways) if ways.contains(&name) => {
                        self.leave_out_sources(document, ways, change, above)
                    }
                    _ => Vec::new(),
                });
            }
        }
        notes
    }

    /// Removes the sources of a curve other than the one that is set, and the keys that describe how a source is read.
    fn leave_out_sources(
        &self,
        document: &mut DeTable<'_>,
        ways: &[&str],
        change: &Assignment,
        above: &str,
    ) -> Vec<BuildWarning> {
        let reason = format!("{} is set", change.key);
        let mut left_out = |key: &str| self.left_out(document, &format!("{above}.{key}"), &reason);
        let others = ways
            .iter()
            .filter(|way| !change.key.ends_with(&format!(".{way}")));
        let mut notes: Vec<_> = others.filter_map(|way| left_out(way)).collect();
        if !notes.is_empty() {
            notes.extend(KEYS_OF_SOURCE.iter().filter_map(|key| left_out(key)));
        }
        notes
    }

    fn leave_out_choice(
        &self,
        document: &mut DeTable<'_>,
        choices: &Choices,
        change: &Assignment,
        above: &str,
    ) -> Vec<BuildWarning> {
        let before = value_at(document, &change.key).and_then(|word| word.get_ref().as_str());
        let before = before.unwrap_or(choices.default).to_owned();
        let value = change.value();
        let word = value.trim_matches(['"', '\'']);
        let set = format!("{} = {value}, which is set", change.key);
        let mut notes = Vec::new();
        let offered = choices.offered.iter().flat_map(|offer| &offer.items);
        for name in offered.filter_map(Item::name) {
            let reason = if choices.other_owner(name, word).is_some() {
                format!("it does not apply to {set}")
            } else if choices
                .default_of(name, &before)
                .is_some_and(|default| Some(default) != choices.default_of(name, word))
            {
                format!("it has another default for {set}")
            } else {
                continue;
            };
            notes.extend(self.left_out(document, &format!("{above}.{name}"), &reason));
        }
        notes
    }

    /// Removes the drives of joints that presets drive differently, and their waveforms, unless they were set too, if another preset
    /// of the machine is set: a case that writes all keys would keep those of the preset before.
    pub fn leave_out_drives(&self, document: &mut DeTable<'_>) -> Vec<BuildWarning> {
        let own = value_at(document, "machine.preset").and_then(|own| own.get_ref().as_str());
        let own = quoted(own.unwrap_or(Preset::StanmoreForce.word()));
        let is_other =
            |change: &&Assignment| change.key == "machine.preset" && change.value() != own;
        let Some(change) = self.changes.iter().find(is_other) else {
            return Vec::new();
        };
        let reason = format!(
            "it does not apply to {} = {}, which is set",
            change.key,
            change.value()
        );
        let mut notes = Vec::new();
        for joint in &KNEE.joints {
            if let (Some(load), Some(motion)) = (joint.load_channel(), joint.motion) {
                let drive = format!("freedoms.{}.drive", joint.name);
                for key in [&drive, load.name, motion.name] {
                    notes.extend(self.left_out(document, &format!("machine.{key}"), &reason));
                }
            }
        }
        notes
    }

    /// Removes a key or table for a `reason`, unless it is set too.
    fn left_out(
        &self,
        document: &mut DeTable<'_>,
        path: &str,
        reason: &str,
    ) -> Option<BuildWarning> {
        let is_below = |other: &Assignment| {
            let rest = other.key.strip_prefix(path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        if self.changes.iter().any(is_below) {
            return None;
        }
        let (_, value) = take(document, path)?;
        let written = match value.get_ref() {
            DeValue::Table(_) => format!("[{path}]"),
            // Points may fill pages.
            DeValue::Array(_) => path.to_owned(),
            _ => format!("{path} = {}", &self.shown[value.span()]),
        };
        Some(BuildWarning::new(format!(
            "{written}: ignored, since {reason}"
        )))
    }
}

/// Keys of a curve that belong to its source, such as a factor that converts units.
const KEYS_OF_SOURCE: [&str; 6] = [
    "column",
    "scale",
    "offset",
    "remove_drift",
    "low_pass_harmonics",
    "interpolation",
];

/// Returns the entries of the table at the dotted `path`, with those of every word of its choices.
fn items_at<'i>(items: &'i [Item], path: &str) -> Vec<&'i Item> {
    let mut all: Vec<&Item> = items.iter().collect();
    for item in items {
        if let Item::Choice(choices) = item {
            all.extend(choices.offered.iter().flat_map(|offer| &offer.items));
        }
    }
    if path.is_empty() {
        return all;
    }
    let (first, rest) = path.split_once('.').unwrap_or((path, ""));
    let inside = all.into_iter().filter_map(|item| match item {
        Item::Table(table) if table.name == first => Some(table),
        _ => None,
    });
    inside
        .flat_map(|table| {
            // A table of a list follows under its own name.
            let own = rest.split_once('.').map_or("", |(_, below)| below);
            items_at(&table.items, if table.is_list { own } else { rest })
        })
        .collect()
}

impl Case {
    /// Returns the dotted path of every key with its value, including defaults, in the order in which they are
    /// written.
    pub(super) fn keys(&self) -> Vec<(String, toml::Value)> {
        let mut keys = Vec::new();
        add_keys(self.to_toml().parse().unwrap_or_default(), "", &mut keys);
        keys
    }

    fn value_at(&self, path: &str) -> Option<toml::Value> {
        let path = current_path(path);
        let mut keys = self.keys().into_iter();
        keys.find_map(|(key, value)| (key == path).then_some(value))
    }

    /// Returns the number at the dotted `path`, which may be a default.
    pub fn number_at(&self, path: &str) -> Option<f64> {
        let value = self.value_at(path)?;
        value
            .as_float()
            .or(value.as_integer().map(|whole| whole as f64))
    }

    /// Returns the number at the dotted `path` in the case; a number of the processing of a waveform, which is not
    /// part of a read case, is that of the file.
    pub fn number_at_or_written(&self, path: &str) -> Option<f64> {
        let written = || {
            let text = self.origin.source.inner();
            let text = text.get(self.origin.places.get(path)?.clone())?;
            number(DeValue::parse(text).ok()?.get_ref())
        };
        let default = || match leaf(path) {
            "scale" => Some(1.0),
            "offset" => Some(0.0),
            _ => None,
        };
        self.number_at(path).or_else(written).or_else(default)
    }

    /// Returns whether the case file or a change has written the key at the dotted `path`.
    pub fn is_written(&self, path: &str) -> bool {
        self.origin.places.contains_key(path)
    }

    /// Returns the word at the dotted `path`, which may be a default.
    pub fn word_at(&self, path: &str) -> Option<String> {
        self.value_at(path)?.as_str().map(str::to_owned)
    }

    /// Returns true if the case has a key or a table at the dotted `path`, including defaults.
    pub fn has(&self, path: &str) -> bool {
        let path = current_path(path);
        let is_below = |(key, _): &(String, _)| {
            let rest = key.strip_prefix(&path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        self.keys().iter().any(is_below)
    }

    /// Returns true if the number at the dotted `path` is a count.
    pub fn is_whole_number(&self, path: &str) -> bool {
        self.value_at(path).is_some_and(|value| value.is_integer())
    }

    /// Returns the dotted path of the key that `written` names: a dotted path, or its last word with or without the unit.
    pub(crate) fn path_of_key(&self, written: &str) -> Result<String, AssignmentError> {
        let paths = || self.keys().into_iter().map(|(path, _)| path).collect();
        path_called("key", written, paths, |names| likeliest(written, names))
    }

    /// Returns the dotted path of the number that `written` names: a dotted path, or its last word with or without the
    /// unit.
    ///
    /// # Errors
    /// No number has that name, or several have it.
    pub fn path_of_number(&self, written: &str) -> Result<String, AssignmentError> {
        let paths = || {
            let is_number = |value: &toml::Value| value.is_integer() || value.is_float();
            let keys = self.keys().into_iter();
            keys.filter(|(_, value)| is_number(value))
                .map(|(path, _)| path)
                .collect()
        };
        let near = |names: &[&str]| nearest(written, names.iter().copied());
        let is_auto = matches!(self.march.update, Update::Auto(_));
        if written == "updates" && is_auto {
            return Err(AssignmentError(
                "the march of this case determines its updates, since it has update = \"auto\"; vary its tolerance, \
                 such as depth_tolerance_fraction=0.1,0.03,0.01, or write update = \"fixed\""
                    .to_owned(),
            ));
        }
        path_called("number", written, paths, near)
    }
}

fn add_keys(table: toml::Table, above: &str, keys: &mut Vec<(String, toml::Value)>) {
    for (name, value) in table {
        let path = match above {
            "" => name,
            above => format!("{above}.{name}"),
        };
        match value {
            toml::Value::Table(inside) => add_keys(inside, &path, keys),
            // A table of a list has its name in its path: `activity.stairs.share`.
            toml::Value::Array(list) if list.iter().all(toml::Value::is_table) => {
                for table in list {
                    if let toml::Value::Table(table) = table
                        && let Some(name) = table.get("name").and_then(toml::Value::as_str)
                    {
                        let path = format!("{path}.{name}");
                        add_keys(table, &path, keys);
                    }
                }
            }
            value => keys.push((path, value)),
        }
    }
}

/// Returns `written` if it is a dotted path, or else the only one of `paths` whose last word it is, with or without the
/// unit; `near` finds a similar last word for the message.
fn path_called(
    what: &str,
    written: &str,
    paths: impl FnOnce() -> Vec<String>,
    near: impl FnOnce(&[&str]) -> Option<String>,
) -> Result<String, AssignmentError> {
    if written.contains('.') {
        return Ok(current_path(written));
    }
    let paths = paths();
    let meant = paths.iter().filter(|path| is_called(path, written));
    let meant: Vec<String> = meant.cloned().collect();
    match <[String; 1]>::try_from(meant) {
        Ok([path]) => Ok(path),
        Err(meant) if meant.is_empty() => {
            let leaves: Vec<&str> = paths.iter().map(|path| leaf(path)).collect();
            let advice = match near(&leaves) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "give its dotted path, such as `march.updates`".to_owned(),
            };
            let message = format!("the case has no {what} called `{written}`; {advice}");
            Err(AssignmentError(message))
        }
        Err(paths) => Err(AssignmentError(format!(
            "the case has more than one {what} named `{written}`; write `{}`",
            paths.join("` or `")
        ))),
    }
}

/// Returns whether `written` is the last word of a path, with or without the unit.
fn is_called(path: &str, written: &str) -> bool {
    leaf(path) == written || split_unit(leaf(path)).0 == written
}

fn leaf(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}
