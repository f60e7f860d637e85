//! Everything that is wrong with a file.

use std::sync::Arc;

use super::problem::Problem;
use super::reason::Reason;
use super::source::Source;

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
