//! A run in memory finds what a run into a folder writes.

use condyle_results::catalogue;
use std::fs;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

use condyle::{
    evolve::March,
    geometry::TriangleMesh,
    wear::{MeanCycle, NamedLaw, NodeWear, WearLaw},
};
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

/// Archard's law, which keeps the highest pressure that it is given, MPa.
#[derive(Debug, Default)]
struct HighestPressure(Mutex<f64>);

impl WearLaw for HighestPressure {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let pressures = cycle.moments().map(|(_, moment)| moment.pressure_mpa);
        let highest = pressures.fold(0.0, f64::max);
        let mut so_far = self.0.lock().expect("no thread has panicked");
        *so_far = so_far.max(highest);
        NodeWear::of_depth(1e-9 * cycle.pressure_slip_mpa_mm)
    }
}

#[test]
fn an_own_law_is_given_no_pressure_above_the_peak_of_the_contact() {
    let text = format!("{CASE}[contact]\nmodel = \"deformable\"\n[accuracy]\nestimate = false\n");
    let case = Case::parse(&text, "case", ".".as_ref()).expect("a good case");
    let law = Arc::new(HighestPressure::default());
    let how = InMemory {
        threads: 1,
        cache: Cache::off(),
        wear_law: Some(NamedLaw {
            word: "own",
            law: Arc::clone(&law) as Arc<dyn WearLaw>,
        }),
    };
    let mut go_on = |_: RunEvent<'_>| ControlFlow::Continue(());
    let outcome = run_in_memory(&case, &how, &mut Counted::default(), &mut go_on);
    let Ok(Outcome::Done(summary)) = outcome else {
        panic!("{outcome:?}");
    };
    let (highest_mpa, peak_mpa) = (
        *law.0.lock().unwrap(),
        summary[&catalogue::PEAK_PRESSURE_MPA],
    );
    assert!(highest_mpa < 1.05 * peak_mpa, "{highest_mpa} {peak_mpa}");
}
