//! Problems and notes collected while a file is read.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use condyle::wear::{WEAR_LAWS, WearLawKind};

#[cfg(feature = "file-system")]
use super::problem::Problems;
use super::problem::{Placed, Problem, Source};
use super::reason::Reason;
use condyle_mesh::files::Files;

/// The files and the folder from which the paths in a file are resolved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Base<'a> {
    pub(crate) files: &'a Arc<dyn Files>,
    pub(crate) folder: &'a Path,
}

impl<'a> Base<'a> {
    /// Returns the folder of the file at `path`.
    pub(crate) fn of(files: &'a Arc<dyn Files>, path: &'a Path) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self { files, folder }
    }
}

/// Problems found so far in one file and the files it names.
pub(crate) struct Log<'a> {
    source: Source,
    base: Base<'a>,
    problems: Vec<Problem>,
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

    /// Returns a log of the same file whose problems are discarded.
    pub(crate) fn discarded(&self) -> Self {
        Self::new(&self.source, self.base)
    }

    pub(crate) fn source(&self) -> &Source {
        &self.source
    }

    pub(crate) fn base(&self) -> Base<'a> {
        self.base
    }

    /// Adds a problem of the file.
    pub(crate) fn problem(&mut self, span: Range<usize>, reason: impl Reason) {
        self.placed(None, Placed::new(span, reason));
    }

    /// Adds a problem of the file, or of `source`, a file that this one names.
    pub(crate) fn placed(&mut self, source: Option<&Source>, placed: Placed) {
        let at = placed.span.start;
        let mut problem = Problem::placed(source.unwrap_or(&self.source), placed);
        if source.is_none() {
            let holds = |(place, _): &&(Range<usize>, String)| place.contains(&at);
            problem.key = self
                .places
                .iter()
                .rfind(holds)
                .map(|(_, path)| path.clone());
        }
        self.problems.push(problem);
    }

    /// Adds the problems of another file that was read for this one.
    #[cfg(feature = "file-system")]
    pub(crate) fn of_other_file(&mut self, problems: &Problems) {
        self.problems.extend_from_slice(problems.problems());
    }

    /// Returns what was read from `source`, a file that this one names, or adds its problems.
    pub(crate) fn noted<T>(&mut self, source: &Source, read: Result<T, Vec<Placed>>) -> Option<T> {
        let add = |all: Vec<Placed>| {
            for one in all {
                self.placed(Some(source), one);
            }
        };
        read.map_err(add).ok()
    }

    pub(crate) fn into_problems(self) -> Vec<Problem> {
        self.problems
    }
}
