//! One thing that is wrong, at its place.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::key_at::key_at;
use super::reason::Reason;
use super::source::Source;

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
