//! Many runs of a case, side by side, of which nothing is written.

use std::{
    ops::ControlFlow,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use condyle::evolve::{March, MarchError};
use condyle_io::{
    cache::Cache,
    case::Case,
    results::{LawWear, NeutralPose, Summary, SummaryInput},
};
use thiserror::Error;

use crate::{
    RunError,
    run::{build, start},
};

/// Why a case is not run to its end.
#[derive(Debug, Error)]
pub enum CaseFailed {
    /// The case as it is.
    #[error(transparent)]
    Case(#[from] RunError),
    /// Its march.
    #[error("the case as it is: {0}")]
    March(#[from] MarchError),
}

/// What is said first.
pub(super) fn first_line(words: &impl ToString) -> String {
    let words = words.to_string();
    words.lines().next().unwrap_or_default().to_owned()
}

/// The summary of a case whose march is done.
pub(super) fn marched(case: &Case) -> Result<Summary, CaseFailed> {
    let built = build(case, 1, &Cache::of_user())?;
    let mut march = start(case, built.test, &built.warnings)?;
    while !march.is_done() {
        let _ = march.update(&mut |_| ControlFlow::Continue(()))?;
    }
    Ok(summary_of(case, &march))
}

/// What a march that is done found, without its error.
pub(super) fn summary_of(case: &Case, march: &March) -> Summary {
    let summary = Summary::new(SummaryInput {
        state: march.state(),
        increments: march.test().time.increments,
        hexahedra: march.insert().mesh().hexes.len(),
        articulating_nodes: march.insert().surface_nodes().len(),
        wall_s: 0.0,
        inputs_blake3: String::new(),
        warnings: Vec::new(),
        error: None,
        neutral_pose: NeutralPose::of(march, case.heading.side),
        activities: Vec::new(),
        wear_laws: LawWear::of(march, &case.wear),
        pressure_law_peak_error_percent: case.contact.law.peak_error_percent(),
    });
    summary.expect("a march that is done has an update")
}

/// `work` for each of `count` indices, in their order, `threads` at a time.
pub(super) fn in_parallel<T: Send>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
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
