//! A case run again with each of its assumptions changed, one at a time.

mod assumption;
mod found;

use std::{
    ops::ControlFlow,
    path::Path,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use condyle::evolve::MarchError;
use condyle_io::{
    cache::Cache,
    case::Case,
    results::{LawWear, NeutralPose, Summary, SummaryInput},
};
use thiserror::Error;

use crate::{
    RunError,
    run::{self, build, start},
};
use assumption::changes_of;

pub use assumption::Change;
pub use found::{Changed, Results, Sensitivity, SensitivityQuantity, sensitivity_quantities};

/// Why a study of sensitivities is not done.
#[derive(Debug, Error)]
pub enum SensitivityError {
    /// The case as it is.
    #[error(transparent)]
    Case(#[from] RunError),
    /// Its march.
    #[error("the case as it is: {0}")]
    March(#[from] MarchError),
}

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
) -> Result<Sensitivity, SensitivityError> {
    let case = Case::read(case_path).map_err(RunError::Case)?;
    let as_given = marched(&case)?;
    let changes = changes_of(&case);
    let ran = in_parallel(changes.len(), threads, |index| {
        let change = &changes[index];
        let found = changed(case_path, &case, change);
        tell(change);
        found
    });
    let all = changes.into_iter().zip(ran);
    let changed = all.filter_map(|(change, ran)| Some((change, ran?)));
    Ok(Sensitivity::of(&as_given, changed))
}

/// What a run with one change found, or why it found nothing; none where the case stays the same.
fn changed(case_path: &Path, case: &Case, change: &Change) -> Option<Result<Summary, String>> {
    match run::changed(case_path, &change.assignments) {
        Ok(other) if other == *case => None,
        Ok(other) => Some(marched(&other).map_err(|error| first_line(&error))),
        Err(error) => Some(Err(first_line(&error))),
    }
}

fn first_line(words: &impl ToString) -> String {
    let words = words.to_string();
    words.lines().next().unwrap_or_default().to_owned()
}

/// The summary of a case whose march is done.
fn marched(case: &Case) -> Result<Summary, SensitivityError> {
    let built = build(case, 1, &Cache::of_user())?;
    let mut march = start(case, built.test, &built.warnings)?;
    while !march.is_done() {
        let _ = march.update(&mut |_| ControlFlow::Continue(()))?;
    }
    let summary = Summary::new(SummaryInput {
        state: march.state(),
        increments: march.test().time.increments,
        hexahedra: march.insert().mesh().hexes.len(),
        articulating_nodes: march.insert().surface_nodes().len(),
        wall_s: 0.0,
        inputs_blake3: String::new(),
        warnings: Vec::new(),
        error: None,
        neutral_pose: NeutralPose::of(&march, case.heading.side),
        activities: Vec::new(),
        wear_laws: LawWear::of(&march, &case.wear),
    });
    Ok(summary.expect("a march that is done has an update"))
}

/// `work` for each of `count` indices, in their order, `threads` at a time.
fn in_parallel<T: Send>(count: usize, threads: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let done: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let taken = AtomicUsize::new(0);
    let run = || {
        loop {
            let index = taken.fetch_add(1, Ordering::Relaxed);
            let Some(place) = done.get(index) else { break };
            *place.lock().expect("no thread panics with it") = Some(work(index));
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, count.max(1)) {
            scope.spawn(run);
        }
    });
    let found = |place: Mutex<Option<T>>| place.into_inner().expect("no thread panics with it");
    done.into_iter().filter_map(found).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_keeps_its_order_on_any_number_of_threads() {
        let squares: Vec<usize> = (0..20).map(|i| i * i).collect();
        for threads in [0, 1, 3, 50] {
            assert_eq!(in_parallel(20, threads, |i| i * i), squares);
        }
        assert!(in_parallel(0, 4, |i| i).is_empty());
    }
}
