//! Problems found while a file is read.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

#[cfg(feature = "file-system")]
use super::problem::Problems;
use super::problem::{Placed, Problem, Source};
use super::reason::Reason;
use condyle_mesh::files::Files;

/// Where the files that a file names are looked for.
#[derive(Clone, Copy, Debug)]
pub struct Base<'a> {
    /// What has them.
    pub(crate) files: &'a Arc<dyn Files>,
    /// The folder that their paths count from.
    pub(crate) folder: &'a Path,
}

impl<'a> Base<'a> {
    /// The folder of the file at `path`.
    pub(crate) fn of(files: &'a Arc<dyn Files>, path: &'a Path) -> Self {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self { files, folder }
    }
}

/// Problems found so far, in one file and the files it names.
pub struct Log<'a> {
    source: Source,
    base: Base<'a>,
    problems: Vec<Problem>,
}

impl<'a> Log<'a> {
    pub(crate) fn new(source: &Source, base: Base<'a>) -> Self {
        Self {
            source: Arc::clone(source),
            base,
            problems: Vec::new(),
        }
    }

    /// A log of the same file whose problems are not reported.
    pub(crate) fn unheard(&self) -> Self {
        Self::new(&self.source, self.base)
    }

    /// The file itself.
    pub(crate) fn source(&self) -> &Source {
        &self.source
    }

    /// Where the files that it names are looked for.
    pub(crate) fn base(&self) -> Base<'a> {
        self.base
    }

    /// Notes a problem in the file.
    pub(crate) fn problem(&mut self, span: Range<usize>, reason: impl Reason) {
        let problem = Problem::at(&self.source, span, reason);
        self.problems.push(problem);
    }

    /// Notes a problem in the file, or in `source` if there is one: a file that this one names.
    pub(crate) fn placed(&mut self, source: Option<&Source>, placed: Placed) {
        let source = source.unwrap_or(&self.source);
        self.problems.push(Problem::placed(source, placed));
    }

    /// Notes what is wrong with another file that was read for this one.
    #[cfg(feature = "file-system")]
    pub(crate) fn of_other_file(&mut self, problems: &Problems) {
        self.problems.extend_from_slice(problems.problems());
    }

    /// What `source`, a file that this one names, was read as, or nothing and its problems noted.
    pub(crate) fn noted<T>(&mut self, source: &Source, read: Result<T, Vec<Placed>>) -> Option<T> {
        let placed = |all: Vec<Placed>| all.into_iter().map(|one| Problem::placed(source, one));
        read.map_err(|problems| self.problems.extend(placed(problems)))
            .ok()
    }

    pub(crate) fn into_problems(self) -> Vec<Problem> {
        self.problems
    }
}
