//! Tables of a file: finding keys, reporting those that are not known, and changes of a parsed file before it is read.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::fault::{Fault, explain, idle, missing_key, syntax, type_fault};
use super::key::{Key, type_name};
use super::problem::{Base, Log, Problems, Source};
use super::render::steers;
use super::setting::Setting;

/// A table of a file; an absent one has no keys.
pub(crate) struct Section<'a> {
    /// Such as `machine.springs`.
    pub path: String,
    is_of_list: bool,
    table: Option<&'a DeTable<'a>>,
    span: Range<usize>,
}

impl<'a> Section<'a> {
    pub(crate) fn root(table: &'a DeTable<'a>) -> Self {
        Self {
            path: String::new(),
            is_of_list: false,
            table: Some(table),
            span: 0..0,
        }
    }

    /// Returns the table `name` inside this one; reports a value that is not a table.
    pub(crate) fn table(&self, name: &str, log: &mut Log<'_>) -> Self {
        let part = self.part(name);
        if let (Some(value), None) = (self.value(name), part.table) {
            let found = type_name(value.get_ref());
            let wanted = format!("a table, [{}]", part.path);
            log.problem(value.span(), type_fault(name, &wanted, found));
        }
        part
    }

    /// Returns the table `name` inside this one; an absent table if it is not a table.
    pub(crate) fn part(&self, name: &str) -> Self {
        let path = match self.path.as_str() {
            "" => name.to_owned(),
            above => format!("{above}.{name}"),
        };
        let entry = self.entry(name);
        Self {
            path,
            is_of_list: false,
            table: entry.and_then(|(_, value)| value.get_ref().as_table()),
            span: entry.map_or(self.span.clone(), |(key, _)| key.span()),
        }
    }

    /// Returns the tables of the list `name` in this one, or reports a value of another type.
    pub(crate) fn list(&self, name: &str, log: &mut Log<'_>) -> Option<Vec<Self>> {
        let Some(value) = self.value(name) else {
            return Some(Vec::new());
        };
        let items = value.get_ref().as_array().map(|items| items.len());
        let tables = self.tables(name);
        // Programs write a list without tables as an empty array.
        if items != Some(tables.len()) {
            let wanted = format!("tables, each headed [[{}]]", self.part(name).path);
            let fault = type_fault(name, &wanted, type_name(value.get_ref()));
            return log.reject(self.key_span(name), fault);
        }
        Some(tables)
    }

    /// Reads every table of the list `name`; returns none if one of them has a problem.
    pub(crate) fn read_list<T>(
        &self,
        name: &str,
        log: &mut Log<'_>,
        mut read: impl FnMut(&Self, &mut Log<'_>) -> Option<T>,
    ) -> Option<Vec<T>> {
        let tables = self.list(name, log)?;
        let read: Vec<Option<T>> = tables.iter().map(|table| read(table, log)).collect();
        read.into_iter().collect()
    }

    /// Reports the first table of a list that has the `name` of another.
    pub(crate) fn check_names_differ(&self, list: &str, log: &mut Log<'_>) -> Option<()> {
        let mut names = BTreeSet::new();
        for table in self.tables(list) {
            let name = table.value("name").and_then(|name| name.get_ref().as_str());
            if let Some(name) = name.filter(|name| !names.insert(name.to_string())) {
                let fault = Fault::new(
                    format!("two {list} are called \"{name}\""),
                    "give each its own name",
                );
                return log.reject(table.value_span("name"), fault);
            }
        }
        Some(())
    }

    /// Returns every table called `name`: none, one, or those of a list.
    pub(crate) fn tables(&self, name: &str) -> Vec<Self> {
        let Some(list) = self
            .value(name)
            .and_then(|value| value.get_ref().as_array())
        else {
            let part = self.part(name);
            return part.table.is_some().then_some(part).into_iter().collect();
        };
        let table = |item: &'a Spanned<DeValue<'a>>| {
            Some(Self {
                path: self.part(name).path,
                is_of_list: true,
                table: Some(item.get_ref().as_table()?),
                span: item.span(),
            })
        };
        list.iter().filter_map(table).collect()
    }

    /// Returns the table as messages name it.
    pub(crate) fn name(&self) -> String {
        match self.path.as_str() {
            "" => "the top of the file".to_owned(),
            path if self.is_of_list => format!("[[{path}]]"),
            path => format!("[{path}]"),
        }
    }

    /// Place of the table's name; of the table around it if it is absent.
    pub(crate) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    fn entry(&self, name: &str) -> Option<(&'a Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>)> {
        self.table?.get_key_value(name)
    }

    pub(crate) fn value(&self, name: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.entry(name).map(|(_, value)| value)
    }

    /// Returns the place of every key and table below, with its dotted path: of a key its name and its value, of a table
    /// its name.
    pub(crate) fn places(&self) -> Vec<(Range<usize>, String)> {
        let mut places = Vec::new();
        for (key, value) in self.table.into_iter().flatten() {
            let (part, inside) = (self.part(key.get_ref()), self.tables(key.get_ref()));
            places.push((key.span(), part.path.clone()));
            if inside.is_empty() {
                places.push((value.span(), part.path));
            }
            places.extend(inside.iter().flat_map(Self::places));
        }
        places
    }

    /// Place of the name of the key `name`, or of the table if it is not given.
    pub(crate) fn key_span(&self, name: &str) -> Range<usize> {
        self.entry(name).map_or(self.span(), |(key, _)| key.span())
    }

    /// Place of the value of `name`, or of the table if it is not given.
    pub(crate) fn value_span(&self, name: &str) -> Range<usize> {
        self.value(name).map_or(self.span(), Spanned::span)
    }

    /// Place of an item of the list behind `name`, or of the whole value.
    pub(crate) fn item_span(&self, name: &str, index: usize) -> Range<usize> {
        let list = self
            .value(name)
            .and_then(|value| value.get_ref().as_array());
        let item = list.and_then(|list| list.get(index));
        item.map_or(self.value_span(name), Spanned::span)
    }

    /// Returns the value of `key` or its default; reports a missing or wrong value.
    pub fn setting<T: Setting>(
        &self,
        key: &Key,
        default: Option<T>,
        log: &mut Log<'_>,
    ) -> Option<T> {
        if let Some(value) = self.value(key.name) {
            return T::read(value, key, log);
        }
        if default.is_none() {
            let fault = missing_key(&self.name(), key.name, &key.kind.to_string());
            log.problem(self.span(), fault);
        }
        default
    }

    /// Reports each of `keys` that is given, because it has an effect only with `needs`.
    pub(crate) fn report_idle(
        &self,
        keys: impl IntoIterator<Item = &'static str>,
        needs: &str,
        log: &mut Log<'_>,
    ) {
        for key in keys.into_iter().filter(|key| self.value(key).is_some()) {
            log.problem(self.key_span(key), idle(key, needs));
        }
    }

    pub(crate) fn check_keys(&self, known: &[&str], log: &mut Log<'_>) {
        for (key, value) in self.other_keys(known) {
            let fault = explain(key.get_ref(), value, &self.name(), known);
            log.problem(key.span(), fault);
        }
    }

    /// Returns the keys of the table that are none of `known`, with their values.
    pub(super) fn other_keys(
        &self,
        known: &[&str],
    ) -> impl Iterator<Item = (&'a Spanned<DeString<'a>>, &'a DeValue<'a>)> {
        let entries = self.table.into_iter().flatten();
        entries
            .filter(|(key, _)| !known.contains(&key.get_ref().as_ref()))
            .map(|(key, value)| (key, value.get_ref()))
    }
}

/// Parses the file `source` and returns the result of `read`; paths in the file are relative to
/// `base`.
///
/// # Errors
/// Every problem; only the syntax errors if there are any.
pub(crate) fn read_document<T>(
    source: &Source,
    base: Base<'_>,
    read: impl FnOnce(&Section<'_>, &mut Log<'_>) -> Option<T>,
) -> Result<T, Problems> {
    read_part(source, source.inner(), base, |document, log| {
        let root = Section::root(document);
        log.places = root.places();
        read(&root, log)
    })
}

/// Like [`read_document`], for a parsed document whose `text` begins the displayed `source`.
pub(crate) fn read_part<'a, T>(
    source: &Source,
    text: &'a str,
    base: Base<'a>,
    read: impl FnOnce(&mut DeTable<'a>, &mut Log<'a>) -> Option<T>,
) -> Result<T, Problems> {
    let (document, errors) = DeTable::parse_recoverable(text);
    let mut log = Log::new(source, base);
    for error in &errors {
        log.problem(error.span().unwrap_or(0..0), syntax(error.message()));
    }
    // After a syntax error, keys may be in the wrong tables: their problems would mislead.
    let found = if errors.is_empty() {
        let mut document = document.into_inner();
        let found = read(&mut document, &mut log);
        // Afterwards, since changes from the command line are put into the document.
        report_steering(document.values(), &mut log);
        found
    } else {
        None
    };
    let problems = log.problems;
    match found {
        Some(found) if problems.is_empty() => Ok(found),
        Some(_) | None => Err(Problems::new(problems, source)),
    }
}

/// Reports texts with control characters: names are written unchanged to tables, pages and pictures.
fn report_steering<'a>(values: impl Iterator<Item = &'a Spanned<DeValue<'a>>>, log: &mut Log<'_>) {
    for value in values {
        match value.get_ref() {
            DeValue::String(text) => {
                if let Some(found) = text.chars().find(|&one| steers(one) && one != '\n') {
                    let message = format!(
                        "this text contains the control character {}",
                        found.escape_unicode()
                    );
                    log.problem(value.span(), Fault::new(message, "remove it"));
                }
            }
            DeValue::Array(items) => report_steering(items.iter(), log),
            DeValue::Table(table) => report_steering(table.values(), log),
            _ => {}
        }
    }
}

/// Most dots of a path whose tables are added; no key of a case or study has as many. The reader of a document recurses
/// into its tables, so a path from outside must not nest them at will.
const MAX_DOTS: usize = 16;

/// Returns the value at a dotted path; a table of a list is found by its `name`.
pub(crate) fn value_at<'a, 'i>(
    table: &'a DeTable<'i>,
    path: &str,
) -> Option<&'a Spanned<DeValue<'i>>> {
    let (first, rest) = path.split_once('.').unwrap_or((path, ""));
    let value = table.get(first)?;
    match value.get_ref() {
        _ if rest.is_empty() => Some(value),
        DeValue::Table(inside) => value_at(inside, rest),
        DeValue::Array(list) => {
            let (name, rest) = rest.split_once('.')?;
            let mut tables = list.iter().filter_map(|item| item.get_ref().as_table());
            value_at(tables.find(|table| is_called(table, name))?, rest)
        }
        _ => None,
    }
}

fn is_called(table: &DeTable<'_>, name: &str) -> bool {
    let called = table.get("name").and_then(|value| value.get_ref().as_str());
    called == Some(name)
}

/// Removes the entry at a dotted path, and returns the place of its key and its value.
pub(crate) fn take<'i>(
    table: &mut DeTable<'i>,
    path: &str,
) -> Option<(Range<usize>, Spanned<DeValue<'i>>)> {
    let (above, name) = path.rsplit_once('.').unwrap_or(("", path));
    let (key, value) = table_at(table, above, None)?.remove_entry(name)?;
    Some((key.span(), value))
}

/// Moves the entry at the dotted path `from`, with its place, to `to`, unless that is given too.
pub(crate) fn rename(table: &mut DeTable<'_>, from: &str, to: &str) -> bool {
    if value_at(table, to).is_some() {
        return false;
    }
    let Some((place, value)) = take(table, from) else {
        return false;
    };
    set_value(table, to, place, value);
    true
}

/// Puts `value` at a dotted path, whose key is at `place`; tables that are missing are added. A path with more than
/// [`MAX_DOTS`] dots is put as one key of `table`, which the reader reports as unknown.
pub(crate) fn set_value<'i>(
    table: &mut DeTable<'i>,
    path: &str,
    place: Range<usize>,
    value: Spanned<DeValue<'i>>,
) {
    let is_deep = path.matches('.').nth(MAX_DOTS).is_some();
    let split = path.rsplit_once('.').filter(|_| !is_deep);
    let (above, name) = split.unwrap_or(("", path));
    if let Some(table) = table_at(table, above, Some(&place)) {
        table.remove(name);
        table.insert(Spanned::new(place, Cow::Owned(name.to_owned())), value);
    }
}

/// Returns the table at a dotted path; with `place`, a missing table is added and replaces a value that is not a
/// table, so that the reader reports its missing entries.
fn table_at<'a, 'i>(
    table: &'a mut DeTable<'i>,
    path: &str,
    place: Option<&Range<usize>>,
) -> Option<&'a mut DeTable<'i>> {
    if path.is_empty() {
        return Some(table);
    }
    let (first, rest) = path.split_once('.').unwrap_or((path, ""));
    if let Some(place) = place
        && !matches!(
            table.get(first).map(Spanned::get_ref),
            Some(DeValue::Table(_) | DeValue::Array(_))
        )
    {
        table.remove(first);
        table.insert(
            Spanned::new(place.clone(), Cow::Owned(first.to_owned())),
            empty(place),
        );
    }
    match table.get_mut(first)?.get_mut() {
        DeValue::Table(inside) => table_at(inside, rest, place),
        DeValue::Array(list) => {
            let (name, rest) = rest.split_once('.').unwrap_or((rest, ""));
            let called = |item: &Spanned<DeValue<'_>>| {
                item.get_ref()
                    .as_table()
                    .is_some_and(|table| is_called(table, name))
            };
            let index = match (list.iter().position(called), place) {
                (Some(index), _) => index,
                (None, Some(place)) => {
                    list.push(empty(place));
                    let added = list.iter_mut().last()?.get_mut();
                    if let DeValue::Table(added) = added {
                        let name = DeValue::String(Cow::Owned(name.to_owned()));
                        set_value(
                            added,
                            "name",
                            place.clone(),
                            Spanned::new(place.clone(), name),
                        );
                    }
                    list.len() - 1
                }
                (None, None) => return None,
            };
            match list.get_mut(index)?.get_mut() {
                DeValue::Table(inside) => table_at(inside, rest, place),
                _ => None,
            }
        }
        _ => None,
    }
}

fn empty<'i>(place: &Range<usize>) -> Spanned<DeValue<'i>> {
    Spanned::new(place.clone(), DeValue::Table(DeTable::new()))
}
