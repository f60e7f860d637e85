//! A run as one of many: nothing is kept of it but what it found.

use std::ops::ControlFlow;

use condyle::evolve::March;
use condyle_io::{
    cache::Cache,
    case::{Case, SharedBodies},
    results::Summary,
};

use super::{
    error::RunError,
    event::RunEvent,
    running::{Run, RunContext, Start},
};

/// The summary of one of many runs: neither a hash of its inputs nor an estimate of its error, and bodies that it has in
/// common with the others.
pub(crate) fn marched(
    case: &Case,
    cache: &Cache,
    bodies: &SharedBodies,
) -> Result<Summary, RunError> {
    march_watched(case, cache, bodies, &mut |_| ()).map(|(_, summary)| summary)
}

/// The march of such a run, which is done, and its summary; `watch` sees it before the first update and after each.
pub(crate) fn march_watched(
    case: &Case,
    cache: &Cache,
    bodies: &SharedBodies,
    watch: &mut dyn FnMut(&March),
) -> Result<(March, Summary), RunError> {
    let means = RunContext {
        threads: 1,
        cache,
        bodies,
        out: None,
        wear_law: None,
    };
    let nobody = &mut |_: RunEvent<'_>| ControlFlow::Continue(());
    Run::begin(case, means, Start::Now, String::new(), nobody)?.marched(watch)
}
