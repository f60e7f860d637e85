//! Tables of a case file: finding keys, reporting what is wrong with them.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::Key;
use super::problems::{Problem, Reason, Source};
use super::setting::{Setting, type_name};
use super::unknown::explain;

/// Problems found so far, in one case file and the files it names.
pub struct Log<'a> {
    source: Source,
    folder: &'a Path,
    problems: Vec<Problem>,
}

impl<'a> Log<'a> {
    pub(crate) fn new(source: &Source, folder: &'a Path) -> Self {
        Self {
            source: Arc::clone(source),
            folder,
            problems: Vec::new(),
        }
    }

    /// The case file.
    pub(crate) fn source(&self) -> &Source {
        &self.source
    }

    /// Folder that paths in the case count from.
    pub(crate) fn folder(&self) -> &'a Path {
        self.folder
    }

    /// Notes a problem in the case file.
    pub(crate) fn problem(&mut self, span: Range<usize>, reason: Reason) {
        let problem = Problem::at(&self.source, span, reason);
        self.problems.push(problem);
    }

    /// Notes a problem in a file that the case names.
    pub(crate) fn problem_in(&mut self, source: &Source, span: Range<usize>, reason: Reason) {
        self.problems.push(Problem::at(source, span, reason));
    }

    pub(crate) fn into_problems(self) -> Vec<Problem> {
        self.problems
    }
}

/// A table of a case file; an absent one has no keys.
pub struct Section<'a> {
    path: String,
    table: Option<&'a DeTable<'a>>,
    span: Range<usize>,
}

impl<'a> Section<'a> {
    /// The whole file.
    pub(crate) fn root(table: &'a DeTable<'a>) -> Self {
        Self {
            path: String::new(),
            table: Some(table),
            span: 0..0,
        }
    }

    /// The table `name` inside this one.
    pub(crate) fn table(&self, name: &str, log: &mut Log<'_>) -> Self {
        let path = match self.path.as_str() {
            "" => name.to_owned(),
            above => format!("{above}.{name}"),
        };
        let entry = self.entry(name);
        let table = entry.and_then(|(_, value)| value.get_ref().as_table());
        if let (Some((_, value)), None) = (entry, table) {
            let found = type_name(value.get_ref());
            let (key, wanted) = (name.to_owned(), format!("a table, [{path}]"));
            log.problem(value.span(), Reason::WrongType { key, wanted, found });
        }
        let span = entry.map_or(self.span.clone(), |(key, _)| key.span());
        Self { path, table, span }
    }

    /// Path of the table, such as `machine.springs`.
    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    /// The table as a message names it.
    pub(crate) fn name(&self) -> String {
        match self.path.as_str() {
            "" => "the top of the file".to_owned(),
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

    fn entry(
        &self,
        name: &str,
    ) -> Option<(
        &'a Spanned<toml::de::DeString<'a>>,
        &'a Spanned<DeValue<'a>>,
    )> {
        self.table?.iter().find(|(key, _)| key.get_ref() == name)
    }

    /// The value of `name`.
    pub(crate) fn value(&self, name: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.entry(name).map(|(_, value)| value)
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
            let reason = Reason::MissingKey {
                key: key.name.to_owned(),
                section: self.name(),
                wanted: (key.kind)(),
            };
            log.problem(self.span(), reason);
        }
        default
    }

    /// Reports every key that is in none of `known`; one that `others` have under a different
    /// choice is said to belong there.
    pub(crate) fn check_keys(&self, known: &[&str], others: &Others<'_>, log: &mut Log<'_>) {
        for (key, value) in self.table.into_iter().flatten() {
            let name = key.get_ref().as_ref();
            if known.contains(&name) {
                continue;
            }
            let reason = match others.owner_of(name) {
                Some(owner) => Reason::OtherChoice {
                    key: name.to_owned(),
                    owner,
                    chosen: others.chosen(),
                },
                None => explain(name, value.get_ref(), &self.name(), known),
            };
            log.problem(key.span(), reason);
        }
    }
}

/// The keys that a table has under each choice of one key, such as `shape`.
pub(crate) struct Others<'a> {
    /// The key that chooses.
    pub key: &'a str,
    /// The word chosen.
    pub word: &'a str,
    /// Words and the keys they bring.
    pub all: &'a [(&'a str, &'a [Key])],
}

impl Others<'_> {
    /// No choices at all.
    pub(crate) const NONE: Others<'static> = Others {
        key: "",
        word: "",
        all: &[],
    };

    fn owner_of(&self, name: &str) -> Option<String> {
        let has = |(_, keys): &&(&str, &[Key])| keys.iter().any(|key| key.name == name);
        let (word, _) = self.all.iter().find(has)?;
        Some(format!("{} = \"{word}\"", self.key))
    }

    fn chosen(&self) -> String {
        format!("{} = \"{}\"", self.key, self.word)
    }
}

/// Names of declared keys.
pub(crate) fn names(keys: &[Key]) -> impl Iterator<Item = &'static str> + '_ {
    keys.iter().map(|key| key.name)
}
