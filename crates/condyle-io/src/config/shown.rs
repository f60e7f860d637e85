//! A problem as it is shown: what is written in a file can do nothing to a terminal.

use std::fmt;
use std::ops::Range;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};

use super::cropped::{with_short_lines, with_short_words};
use super::problem::Problem;
use super::visible::{masked, visible};

/// A problem as it is shown.
#[derive(Debug)]
pub(super) struct Shown<'a> {
    problem: &'a Problem,
    source: Option<NamedSource<String>>,
    /// In the source as it is shown.
    span: Option<Range<usize>>,
}

impl<'a> Shown<'a> {
    pub(super) fn new(problem: &'a Problem) -> Self {
        let Some(source) = problem.source.as_deref() else {
            let (source, span) = (None, problem.span.clone());
            return Self {
                problem,
                source,
                span,
            };
        };
        let place = problem.span.clone().unwrap_or_default();
        let (text, place) = with_short_lines(&masked(source.inner()), &place);
        let name = visible(&with_short_words(source.name()));
        Self {
            problem,
            source: Some(NamedSource::new(name, text)),
            span: problem.span.is_some().then_some(place),
        }
    }
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&visible(&with_short_words(&self.problem.to_string())))
    }
}

impl std::error::Error for Shown<'_> {}

impl Diagnostic for Shown<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let advice = with_short_words(&self.problem.reason.advice()?);
        Some(Box::new(visible(&advice)))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self.source.as_ref()?)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::underline(self.span.clone()?);
        Some(Box::new(std::iter::once(label)))
    }
}
