//! Problems of a file, each at its place.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::reason::{FileReason, Reason};
use condyle_mesh::files::Files;

/// A named text that problems point into.
pub(crate) type Source = Arc<NamedSource<String>>;

/// Reads a file; the name under which problems show it is its path.
pub(crate) fn read_source(files: &dyn Files, path: &Path) -> Result<Source, FileReason> {
    let name = path.display().to_string();
    let unreadable = |why: String| {
        let path = path.to_path_buf();
        FileReason::Unreadable { path, why }
    };
    let bytes = files
        .read(path)
        .map_err(|error| unreadable(error.to_string()))?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Arc::new(NamedSource::new(name, text))),
        Err(_) => Err(unreadable("stream did not contain valid UTF-8".to_owned())),
    }
}

/// A reason and where it stands in a text that is known from elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub span: Range<usize>,
    pub reason: Arc<dyn Reason>,
}

impl Placed {
    pub(crate) fn new(span: Range<usize>, reason: impl Reason) -> Self {
        let reason = Arc::new(reason);
        Self { span, reason }
    }
}

/// One thing that is wrong, at its place.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What is wrong.
    pub reason: Arc<dyn Reason>,
    pub(super) source: Option<Source>,
    pub(super) span: Option<Range<usize>>,
}

impl Problem {
    pub(crate) fn at(source: &Source, span: Range<usize>, reason: impl Reason) -> Self {
        Self::placed(source, Placed::new(span, reason))
    }

    pub(super) fn placed(source: &Source, placed: Placed) -> Self {
        Self {
            reason: placed.reason,
            source: Some(Arc::clone(source)),
            span: Some(placed.span),
        }
    }

    pub(super) fn nowhere(reason: impl Reason) -> Self {
        Self {
            reason: Arc::new(reason),
            source: None,
            span: None,
        }
    }

    /// Line and column, both from 1; none for a file that could not be opened.
    pub fn line_and_column(&self) -> Option<(usize, usize)> {
        let before = self
            .source
            .as_ref()?
            .inner()
            .get(..self.span.as_ref()?.start)?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before[line_start..].chars().count() + 1;
        Some((before.matches('\n').count() + 1, column))
    }

    /// The dotted path of the key that it stands at, or of the table; none outside of any, or in a file of
    /// other kind than TOML.
    pub fn key(&self) -> Option<String> {
        key_at(self.source.as_ref()?.inner(), self.span.as_ref()?)
    }

    /// Name of the file it is in.
    pub fn file(&self) -> Option<&str> {
        self.source.as_ref().map(|source| source.name())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason.fmt(f)
    }
}

impl std::error::Error for Problem {}

/// Everything that is wrong with a file and the files it names, in the order of the file.
#[derive(Clone, Debug)]
pub struct Problems {
    problems: Vec<Problem>,
}

impl Problems {
    /// Problems of the file `main` come first, in its order; then those of files it names.
    pub(crate) fn new(mut problems: Vec<Problem>, main: &Source) -> Self {
        let elsewhere = |problem: &Problem| match &problem.source {
            Some(source) => !Arc::ptr_eq(source, main),
            None => false,
        };
        problems.sort_by_key(|problem| {
            let start = problem.span.as_ref().map(|span| span.start);
            (elsewhere(problem), start.filter(|_| !elsewhere(problem)))
        });
        Self { problems }
    }

    /// A file that cannot be opened.
    pub(crate) fn unreadable(reason: impl Reason) -> Self {
        Self {
            problems: vec![Problem::nowhere(reason)],
        }
    }

    /// The problems, one or more.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }
}

/// The dotted path of the key whose name or value holds the start of `place`, or else of the table; none where the
/// text is no TOML, or the place outside of any key.
pub(super) fn key_at(text: &str, place: &Range<usize>) -> Option<String> {
    let (document, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return None;
    }
    in_table(document.get_ref(), place.start)
}

fn in_table(table: &DeTable<'_>, at: usize) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let name = key.get_ref();
        match below(value, at) {
            Some(path) => Some(format!("{name}.{path}")),
            None if holds(&key.span(), at) || is_at(value, at) => Some(name.to_string()),
            None => None,
        }
    })
}

/// The path of the key below a value. Tables are looked through wherever they stand, since one may be written in parts.
fn below(value: &Spanned<DeValue<'_>>, at: usize) -> Option<String> {
    match value.get_ref() {
        DeValue::Table(table) => in_table(table, at),
        DeValue::Array(items) => items.iter().find_map(|item| below(item, at)),
        _ => None,
    }
}

/// Whether a value that is no table is there.
fn is_at(value: &Spanned<DeValue<'_>>, at: usize) -> bool {
    !matches!(value.get_ref(), DeValue::Table(_)) && holds(&value.span(), at)
}

fn holds(span: &Range<usize>, at: usize) -> bool {
    span.contains(&at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_belongs_to_its_key() {
        let text = "title = 1\n[contact]\nfriction = \"a\"\nlaw = { x = [1, 2] }\n[[activity]]\nname = 3\n";
        let at = |word: &str| {
            let start = text.find(word).unwrap();
            key_at(text, &(start..start + 1))
        };
        assert_eq!(at("1").as_deref(), Some("title"));
        assert_eq!(at("\"a\"").as_deref(), Some("contact.friction"));
        assert_eq!(at("friction").as_deref(), Some("contact.friction"));
        assert_eq!(at("contact").as_deref(), Some("contact"));
        assert_eq!(at("2]").as_deref(), Some("contact.law.x"));
        assert_eq!(at("3").as_deref(), Some("activity.name"));
        assert_eq!(at("= 1"), None);
        assert_eq!(key_at("no toml", &(0..1)), None);
    }
}
