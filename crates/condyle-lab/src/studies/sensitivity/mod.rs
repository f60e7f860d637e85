//! A case run again with each of its assumptions changed, one at a time.

mod assumption;
mod found;

use std::path::Path;

use condyle_io::{
    cache::Cache,
    case::{Case, SharedBodies},
    results::Summary,
};

use super::many_runs::{first_line, in_parallel};
use crate::{
    RunError,
    run::{self, marched},
};
use assumption::changes_of;

pub use assumption::Change;
pub use found::{Changed, Results, Sensitivity, SensitivityQuantity, sensitivity_quantities};

/// Runs the case at `case_path` as it is and with each of its assumptions changed, `threads` at a
/// time; nothing is written, and results do not depend on the threads.
///
/// `tell` hears of every change that has been run, from any thread.
///
/// # Errors
/// A case that cannot be run as it is. A change that cannot be run is among the results.
pub fn sensitivity(
    case_path: &Path,
    threads: usize,
    tell: &(dyn Fn(&Change) + Sync),
) -> Result<Sensitivity, RunError> {
    let case = Case::read(case_path)?;
    let bodies = SharedBodies::default();
    let as_given = marched(&case, &Cache::of_user(), &bodies)?;
    let changes = changes_of(&case);
    let ran = in_parallel(changes.len(), threads, |index| {
        let change = &changes[index];
        let found = changed(case_path, &case, change, &bodies);
        tell(change);
        found
    });
    let all = changes.into_iter().zip(ran);
    let changed = all.filter_map(|(change, ran)| Some((change, ran?)));
    Ok(Sensitivity::of(&as_given, changed))
}

/// What a run with one change found, or why it found nothing; none where the case stays the same.
fn changed(
    case_path: &Path,
    case: &Case,
    change: &Change,
    bodies: &SharedBodies,
) -> Option<Result<Summary, String>> {
    let ran = |other| marched(other, &Cache::of_user(), bodies);
    match run::changed(case_path, &change.assignments) {
        Ok(other) if other == *case => None,
        Ok(other) => Some(ran(&other).map_err(|error| first_line(&error))),
        Err(error) => Some(Err(first_line(&error))),
    }
}
