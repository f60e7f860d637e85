//! A problem as it is shown: what is written in a file can do nothing to a terminal.

use std::fmt;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};

use super::problem::Problem;
use super::visible::{masked, visible};

/// A problem as it is shown.
#[derive(Debug)]
pub(super) struct Shown<'a> {
    problem: &'a Problem,
    source: Option<NamedSource<String>>,
}

impl<'a> Shown<'a> {
    pub(super) fn new(problem: &'a Problem) -> Self {
        let harmless = |source: &NamedSource<String>| {
            NamedSource::new(visible(source.name()), masked(source.inner()))
        };
        let source = problem.source.as_deref().map(harmless);
        Self { problem, source }
    }
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&visible(&self.problem.to_string()))
    }
}

impl std::error::Error for Shown<'_> {}

impl Diagnostic for Shown<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(visible(&self.problem.reason.advice()?)))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self.source.as_ref()?)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::underline(self.problem.span.clone()?);
        Some(Box::new(std::iter::once(label)))
    }
}
