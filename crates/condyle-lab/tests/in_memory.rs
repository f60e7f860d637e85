//! A run in memory finds what a run into a folder writes.

use condyle_results::catalogue;
use std::fs;
use std::ops::ControlFlow;

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_case::{cache::Cache, case::Case};
use condyle_lab::{InMemory, Outcome, RunEvent, RunKeeper, RunOptions, run_case, run_in_memory};
use condyle_results::{Summary, wear_csv};

const CASE: &str = "\
[insert]
edge_mm = 3.0
layers = 1
[march]
updates = 3
[time]
increments = 40
";

/// Counts what it hears of, and keeps the table of wear.
#[derive(Default)]
struct Counted {
    settled: usize,
    updated: usize,
    wear_csv: String,
}

impl RunKeeper for Counted {
    fn settled(&mut self, march: &March, femur: &TriangleMesh) {
        assert!(march.state().updates.is_empty() && !femur.triangles.is_empty());
        self.settled += 1;
    }

    fn updated(&mut self, march: &March) {
        self.updated += 1;
        self.wear_csv = wear_csv(&march.state().updates);
    }
}

fn case() -> Case {
    Case::parse(CASE, "case", ".".as_ref()).expect("a good case")
}

fn in_memory(on_event: &mut dyn FnMut(RunEvent<'_>) -> ControlFlow<()>) -> (Outcome, Counted) {
    let how = InMemory {
        threads: 1,
        cache: Cache::off(),
        wear_law: None,
    };
    let mut counted = Counted::default();
    let outcome = run_in_memory(&case(), &how, &mut counted, on_event);
    (outcome.expect("it runs"), counted)
}

/// The summary of a run that is done, but for what a clock says.
fn timeless(outcome: Outcome) -> Summary {
    let Outcome::Done(mut summary) = outcome else {
        panic!("{outcome:?}");
    };
    summary.set(&catalogue::WALL_S, 0.0);
    if let Some(error) = &mut summary.error {
        error.wall_s = 0.0;
    }
    *summary
}

#[test]
fn a_run_in_memory_finds_what_one_into_a_folder_writes() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let options = RunOptions {
        out: folder.path().join("out"),
        resume: false,
        force: false,
        threads: 1,
        cache: Cache::off(),
        report: true,
    };
    let mut go_on = |_: RunEvent<'_>| ControlFlow::Continue(());
    let written = run_case(&case(), &options, &mut go_on).expect("it runs");
    let (outcome, counted) = in_memory(&mut go_on);
    // Three updates and the final cycle.
    assert_eq!((counted.settled, counted.updated), (1, 4));
    assert_eq!(timeless(outcome), timeless(written));
    let table = fs::read_to_string(options.out.join("wear.csv")).expect("it was written");
    assert_eq!(counted.wear_csv, table);
}

#[test]
fn a_run_in_memory_stops_where_somebody_asks_to() {
    let mut until_second = |event: RunEvent<'_>| match event {
        RunEvent::Updated(update) if update.cycles > 3e6 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let (outcome, counted) = in_memory(&mut until_second);
    assert!(matches!(outcome, Outcome::Interrupted(reached) if reached.updates == 2));
    assert_eq!(counted.updated, 2);
}
