//! Problems of a file, each at its place, collected while the file is read.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use condyle::wear::{WEAR_LAWS, WearLawKind};
use condyle_mesh::files::Files;
use miette::NamedSource;
use thiserror::Error;

use super::fault::Fault;

/// A named text that problems point into.
pub(crate) type Source = Arc<NamedSource<String>>;

/// A fault and its place in a text that the context defines.
pub(crate) type Placed = (Range<usize>, Fault);

/// Reads a file; messages name it by its path.
pub(crate) fn read_source(files: &dyn Files, path: &Path) -> Result<Source, Fault> {
    let name = path.display().to_string();
    let unreadable = |why: &str| Fault::new(format!("the file {name} cannot be read: {why}"), "");
    let bytes = files
        .read(path)
        .map_err(|error| unreadable(&error.to_string()))?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Arc::new(NamedSource::new(name, text))),
        Err(_) => Err(unreadable("it is not UTF-8 text; save it in UTF-8")),
    }
}

/// One problem, at its place; `Display` describes it.
#[derive(Clone, Debug, Error)]
#[error("{}", fault.message)]
pub struct Problem {
    fault: Fault,
    pub(super) text: Option<Source>,
    pub(super) span: Option<Range<usize>>,
    key: Option<String>,
}

impl Problem {
    /// Returns a problem of `source` at the dotted path `key`.
    pub(crate) fn at(source: &Source, (span, fault): Placed, key: Option<String>) -> Self {
        let (text, span) = (Some(Arc::clone(source)), Some(span));
        Self {
            fault,
            text,
            span,
            key,
        }
    }

    /// Returns the remedy, if it does not follow from the description.
    pub fn advice(&self) -> Option<&str> {
        Some(self.fault.advice.as_str()).filter(|advice| !advice.is_empty())
    }

    /// Returns line and column, both from 1; none for a file that could not be opened.
    pub fn line_and_column(&self) -> Option<(usize, usize)> {
        let text = self.text.as_ref()?.inner();
        let before = text.get(..self.span.as_ref()?.start)?;
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
        self.text.as_ref().map(|text| text.name())
    }
}

/// All problems of a file and of the files that it names, in the order of the file.
#[derive(Clone, Debug)]
pub struct Problems {
    problems: Vec<Problem>,
}

impl Problems {
    /// Problems of the file `main` come first, in its order; then those of files it names.
    pub(crate) fn new(mut problems: Vec<Problem>, main: &Source) -> Self {
        let elsewhere = |problem: &Problem| match &problem.text {
            Some(text) => !Arc::ptr_eq(text, main),
            None => false,
        };
        problems.sort_by_key(|problem| {
            let start = problem.span.as_ref().map(|span| span.start);
            (elsewhere(problem), start.filter(|_| !elsewhere(problem)))
        });
        Self { problems }
    }

    /// Creates the problem of a file that cannot be opened.
    pub(crate) fn unreadable(fault: Fault) -> Self {
        let (text, span, key) = (None, None, None);
        let problems = vec![Problem {
            fault,
            text,
            span,
            key,
        }];
        Self { problems }
    }

    /// Returns the problems, one or more.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }
}

/// The files and the folder from which the paths in a file are resolved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Base<'a> {
    pub(crate) files: &'a Arc<dyn Files>,
    pub(crate) folder: &'a Path,
}

impl<'a> Base<'a> {
    pub(crate) fn of(files: &'a Arc<dyn Files>, path: &'a Path) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self { files, folder }
    }
}

/// Problems found so far in one file and the files it names.
pub(crate) struct Log<'a> {
    pub(crate) source: Source,
    pub(crate) base: Base<'a>,
    pub(crate) problems: Vec<Problem>,
    /// Places of the file's keys, with their dotted paths: problems name the key that they are at.
    pub(crate) places: Vec<(Range<usize>, String)>,
    /// Wear laws to choose from; a program may add its own.
    pub(crate) wear_laws: &'static [&'static WearLawKind],
}

impl<'a> Log<'a> {
    pub(crate) fn new(source: &Source, base: Base<'a>) -> Self {
        Self {
            source: Arc::clone(source),
            base,
            problems: Vec::new(),
            places: Vec::new(),
            wear_laws: WEAR_LAWS,
        }
    }

    pub(crate) fn problem(&mut self, span: Range<usize>, fault: Fault) {
        // Tables precede the keys inside them, so the last place that holds the span is the innermost.
        let mut places = self.places.iter();
        let key = places.rfind(|(place, _)| place.contains(&span.start));
        let key = key.map(|(_, path)| path.clone());
        self.problems
            .push(Problem::at(&self.source, (span, fault), key));
    }

    /// Reports a problem in place of a value.
    pub(crate) fn reject<T>(&mut self, span: Range<usize>, fault: Fault) -> Option<T> {
        self.problem(span, fault);
        None
    }

    /// Adds the problems of a file that this one names.
    pub(crate) fn extend(&mut self, problems: Problems) {
        self.problems.extend(problems.problems);
    }

    /// Returns what was read from `source`, a file that this one names, or adds its problems.
    pub(crate) fn noted<T>(&mut self, source: &Source, read: Result<T, Vec<Placed>>) -> Option<T> {
        read.map_err(|all| {
            let problems = all
                .into_iter()
                .map(|placed| Problem::at(source, placed, None));
            self.problems.extend(problems);
        })
        .ok()
    }
}
