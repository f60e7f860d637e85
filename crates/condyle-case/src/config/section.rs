//! Tables of a file: finding keys, reporting those that are not known.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::key::{Key, names, type_name};
use super::log::{Base, Log};
use super::problem::{Problems, Source};
use super::reason::KeyReason;
use super::setting::Setting;
use super::suggest::explain;

/// A key and its value, each with its place.
type Entry<'a> = (&'a Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>);

/// A table of a file; an absent one has no keys.
pub struct Section<'a> {
    path: String,
    /// Whether it is one of a list of tables.
    is_of_list: bool,
    table: Option<&'a DeTable<'a>>,
    span: Range<usize>,
}

impl<'a> Section<'a> {
    /// The whole file.
    pub(crate) fn root(table: &'a DeTable<'a>) -> Self {
        Self {
            path: String::new(),
            is_of_list: false,
            table: Some(table),
            span: 0..0,
        }
    }

    /// The table `name` inside this one.
    pub(crate) fn table(&self, name: &str, log: &mut Log<'_>) -> Self {
        let part = self.part(name);
        if let (Some(value), None) = (self.value(name), part.table) {
            let found = type_name(value.get_ref());
            let (key, wanted) = (name.to_owned(), format!("a table, [{}]", part.path));
            log.problem(value.span(), KeyReason::WrongType { key, wanted, found });
        }
        part
    }

    /// The same, without a report where `name` is no table.
    pub(crate) fn part(&self, name: &str) -> Self {
        let path = match self.path.as_str() {
            "" => name.to_owned(),
            above => format!("{above}.{name}"),
        };
        let entry = self.entry(name);
        let table = entry.and_then(|(_, value)| value.get_ref().as_table());
        let span = entry.map_or(self.span.clone(), |(key, _)| key.span());
        Self {
            path,
            is_of_list: false,
            table,
            span,
        }
    }

    /// The tables of the list `name` at the top of the file; nothing where it is something else.
    pub(crate) fn list(&self, name: &str, log: &mut Log<'_>) -> Option<Vec<Self>> {
        let Some(value) = self.value(name) else {
            return Some(Vec::new());
        };
        let listed = value.get_ref().as_array();
        let tables: Option<Vec<Self>> = listed.and_then(|listed| {
            let table = |item| Self::of_list(name, item);
            listed.iter().map(table).collect()
        });
        let tables = tables.filter(|tables| !tables.is_empty());
        if tables.is_none() {
            let (key, found) = (name.to_owned(), type_name(value.get_ref()));
            let wanted = format!("tables, each headed [[{name}]]");
            let reason = KeyReason::WrongType { key, wanted, found };
            log.problem(self.key_span(name), reason);
        }
        tables
    }

    /// A table of the list `name`; nothing where it is something else.
    fn of_list(name: &str, item: &'a Spanned<DeValue<'a>>) -> Option<Self> {
        Some(Self {
            path: name.to_owned(),
            is_of_list: true,
            table: Some(item.get_ref().as_table()?),
            span: item.span(),
        })
    }

    /// Path of the table, such as `machine.springs`.
    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    /// The table as a message names it.
    pub(crate) fn name(&self) -> String {
        match self.path.as_str() {
            "" => "the top of the file".to_owned(),
            path if self.is_of_list => format!("[[{path}]]"),
            path => format!("[{path}]"),
        }
    }

    /// Whether the file has the table.
    pub(crate) fn is_given(&self) -> bool {
        self.table.is_some()
    }

    /// Where the table is named; where the one around it is, if it is absent.
    pub(crate) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    fn entry(&self, name: &str) -> Option<Entry<'a>> {
        self.table?.iter().find(|(key, _)| key.get_ref() == name)
    }

    /// The value of `name`.
    pub(crate) fn value(&self, name: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.entry(name).map(|(_, value)| value)
    }

    /// The places of all keys and tables in this one, by dotted path: of a key its value, of a table its name.
    pub(crate) fn places(&self) -> BTreeMap<String, Range<usize>> {
        let mut places = BTreeMap::new();
        for (key, value) in self.table.into_iter().flatten() {
            let part = self.part(key.get_ref());
            let is_table = part.is_given();
            places.extend(part.places());
            places.insert(part.path, if is_table { key.span() } else { value.span() });
        }
        places
    }

    /// The word that `name` has, if it has one.
    pub(crate) fn word(&self, name: &str) -> Option<&'a str> {
        self.value(name)?.get_ref().as_str()
    }

    /// Where the name of the key `name` stands, or that of the table.
    pub(crate) fn key_span(&self, name: &str) -> Range<usize> {
        self.entry(name).map_or(self.span(), |(key, _)| key.span())
    }

    /// Where the value of `name` stands, or the name of the table.
    pub(crate) fn value_span(&self, name: &str) -> Range<usize> {
        self.value(name).map_or(self.span(), Spanned::span)
    }

    /// The value behind `key`, its default, or nothing and the reason in `log`.
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
            let reason = KeyReason::MissingKey {
                key: key.name.to_owned(),
                section: self.name(),
                wanted: key.kind.to_string(),
            };
            log.problem(self.span(), reason);
        }
        default
    }

    /// Reports each of `keys` that is given, since it has an effect only with `needs`.
    pub(crate) fn report_idle(&self, keys: &[Key], needs: &str, log: &mut Log<'_>) {
        for key in names(keys).filter(|key| self.value(key).is_some()) {
            let (key, needs) = (key.to_owned(), needs.to_owned());
            log.problem(self.key_span(&key), KeyReason::Idle { key, needs });
        }
    }

    /// Reports every key that is none of `known`.
    pub(crate) fn check_keys(&self, known: &[&str], log: &mut Log<'_>) {
        for (key, value) in self.other_keys(known) {
            log.problem(key.span(), self.unknown(key.get_ref(), value, known));
        }
    }

    /// Keys of the table that are none of `known`, with their values.
    pub(super) fn other_keys(
        &self,
        known: &[&str],
    ) -> impl Iterator<Item = (&'a Spanned<DeString<'a>>, &'a DeValue<'a>)> {
        let entries = self.table.into_iter().flatten();
        entries
            .filter(|(key, _)| !known.contains(&key.get_ref().as_ref()))
            .map(|(key, value)| (key, value.get_ref()))
    }

    /// The likeliest reason why the table has no key `name` among those `known`.
    pub(super) fn unknown(&self, name: &str, value: &DeValue<'_>, known: &[&str]) -> KeyReason {
        explain(name, value, &self.name(), known)
    }
}

/// What `read` makes of the file `source`; those it names are looked for from `base`.
///
/// # Errors
/// Everything that is wrong, what is no TOML before all else.
pub(crate) fn read_document<T>(
    source: &Source,
    base: Base<'_>,
    read: impl FnOnce(&Section<'_>, &mut Log<'_>) -> Option<T>,
) -> Result<T, Problems> {
    let (document, errors) = DeTable::parse_recoverable(source.inner());
    let mut log = Log::new(source, base);
    for error in &errors {
        let message = error.message().to_owned();
        log.problem(error.span().unwrap_or(0..0), KeyReason::Syntax { message });
    }
    let found = if errors.is_empty() {
        read(&Section::root(document.get_ref()), &mut log)
    } else {
        None
    };
    let problems = log.into_problems();
    match found {
        Some(found) if problems.is_empty() => Ok(found),
        Some(_) | None => Err(Problems::new(problems, source)),
    }
}
