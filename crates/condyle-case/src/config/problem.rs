//! Problems of a file, each at its place.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use miette::NamedSource;

use super::reason::{Fault, Reason};
use condyle_mesh::files::Files;

/// A named text that problems point into.
pub(crate) type Source = Arc<NamedSource<String>>;

/// Reads a file; the name under which problems show it is its path.
pub(crate) fn read_source(files: &dyn Files, path: &Path) -> Result<Source, Fault> {
    let name = path.display().to_string();
    let unreadable = |why: &str| Fault::new(format!("the file {name} cannot be read: {why}"), "");
    let bytes = files
        .read(path)
        .map_err(|error| unreadable(&error.to_string()))?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Arc::new(NamedSource::new(name, text))),
        Err(_) => Err(unreadable("stream did not contain valid UTF-8")),
    }
}

/// A reason and its place in a text that the context defines.
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

/// One problem, at its place.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Description of the problem as data.
    pub reason: Arc<dyn Reason>,
    pub(super) source: Option<Source>,
    pub(super) span: Option<Range<usize>>,
    pub(super) key: Option<String>,
}

impl Problem {
    /// Returns a problem of `source` at the dotted path `key`.
    pub(crate) fn at(
        source: &Source,
        span: Range<usize>,
        key: Option<&str>,
        reason: impl Reason,
    ) -> Self {
        let key = key.map(str::to_owned);
        Self {
            key,
            ..Self::placed(source, Placed::new(span, reason))
        }
    }

    pub(super) fn placed(source: &Source, placed: Placed) -> Self {
        Self {
            reason: placed.reason,
            source: Some(Arc::clone(source)),
            span: Some(placed.span),
            key: None,
        }
    }

    pub(super) fn nowhere(reason: impl Reason) -> Self {
        Self {
            reason: Arc::new(reason),
            source: None,
            span: None,
            key: None,
        }
    }

    /// Returns line and column, both from 1; none for a file that could not be opened.
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

    /// Returns the dotted path of the key or table at fault, if there is one.
    pub fn key(&self) -> Option<&str> {
        self.key.as_deref()
    }

    /// Returns the name of the file that has the problem.
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

/// All problems of a file and of the files that it names, in the order of the file.
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

    /// Creates the problem of a file that cannot be opened.
    pub(crate) fn unreadable(reason: impl Reason) -> Self {
        Self {
            problems: vec![Problem::nowhere(reason)],
        }
    }

    /// Returns the problems, one or more.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }
}
