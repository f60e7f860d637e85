//! A run stopped at any increment goes on to the same bytes as one never stopped.

use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use condyle_case::cache::Cache;
use condyle_lab::{Outcome, Preview, RunError, RunEvent, RunOptions, run};
use condyle_results::Checkpoint;
use tempfile::TempDir;

const CASE: &str = "\
[insert]
edge_mm = 3.0
layers = 1
[march]
updates = 3
[time]
increments = 40
";

fn bench(case: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let file = folder.path().join("case.toml");
    fs::write(&file, case).expect("it can be written");
    (folder, file)
}

fn options(out: PathBuf, resume: bool) -> RunOptions {
    RunOptions {
        out,
        resume,
        force: false,
        threads: 1,
        cache: Cache::off(),
        report: true,
    }
}

/// Runs until `stops` says so.
fn run_until(
    case: &Path,
    options: &RunOptions,
    mut stops: impl FnMut(&RunEvent<'_>) -> bool,
) -> Outcome {
    let mut on_event = |on_event: RunEvent<'_>| match stops(&on_event) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    run(case, &[], options, &mut on_event).unwrap_or_else(|error| panic!("{error}"))
}

/// Every file but the summary, which alone has the wall time.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("it is there") {
        let path = entry.expect("it can be read").path();
        let name = PathBuf::from(path.file_name().expect("it has a name"));
        if path.is_dir() {
            let inner = files(&path).into_iter();
            found.extend(inner.map(|(file, bytes)| (name.join(file), bytes)));
        } else if name != Path::new("summary.json") {
            found.insert(name, fs::read(&path).expect("it can be read"));
        }
    }
    found
}

#[test]
fn stopped_at_any_increment_again_and_again() {
    assert_same_bytes_however_stopped(CASE);
}

#[test]
fn a_march_that_finds_its_own_intervals_stopped_at_any_increment() {
    assert_same_bytes_however_stopped(&CASE.replace("updates = 3", "update = \"auto\""));
}

#[test]
fn the_frames_of_the_first_and_last_cycle_stopped_at_any_increment() {
    let case = format!("{CASE}[output]\ncycle_frames = true\n");
    assert_same_bytes_however_stopped(&case);
    let (folder, case) = bench(&case);
    let out = folder.path().join("out");
    run_until(&case, &options(out.clone(), false), |_| false);
    let frames = |cycle: &str| files(&out.join(cycle)).len();
    assert_eq!((frames("cycle_first"), frames("cycle_last")), (80, 80));
}

#[test]
fn an_insert_that_rests_on_its_tray_stopped_at_any_increment() {
    let contact = "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nbackside = \"resting\"\nbackside_spacing_mm = 9.0\n";
    assert_same_bytes_however_stopped(&format!("{CASE}{contact}"));
}

fn assert_same_bytes_however_stopped(case: &str) {
    let (folder, case) = bench(case);
    let whole = folder.path().join("whole");
    let mut increments = 0;
    run_until(&case, &options(whole.clone(), false), |on_event| {
        increments += usize::from(matches!(on_event, RunEvent::Solved(_)));
        false
    });
    let expected = files(&whole);
    for stop_after in [1, 17, 40, 41, increments / 2, increments - 1, increments] {
        let out = folder.path().join(format!("stopped{stop_after}"));
        let mut resume = false;
        // An update takes a few cycles, so that a stop must not come before its end for ever.
        for part in 1.. {
            let mut left = stop_after * part;
            let outcome = run_until(&case, &options(out.clone(), resume), |on_event| {
                left -= usize::from(left > 0 && matches!(on_event, RunEvent::Solved(_)));
                left == 0
            });
            resume = true;
            if let Outcome::Interrupted(reached) = outcome {
                assert!(reached.cycles <= reached.of_cycles && !out.join("summary.json").exists());
                continue;
            }
            break;
        }
        assert!(
            files(&out) == expected,
            "stopped after {stop_after} increments"
        );
    }
}

#[test]
fn stopped_at_the_start_nothing_is_computed_and_nothing_lost() {
    let (folder, case) = bench(CASE);
    let out = folder.path().join("out");
    let outcome = run_until(&case, &options(out.clone(), false), |_| true);
    assert!(matches!(outcome, Outcome::Interrupted(reached) if reached.updates == 0));
    let outcome = run_until(&case, &options(out, true), |_| false);
    assert!(matches!(outcome, Outcome::Done(_)));
}

#[test]
fn a_finished_run_is_not_run_again() {
    let (folder, case) = bench(CASE);
    let out = folder.path().join("out");
    let Outcome::Done(done) = run_until(&case, &options(out.clone(), false), |_| false) else {
        panic!("it was not stopped");
    };
    let again = run_until(&case, &options(out, true), |_| panic!("nothing happens"));
    assert!(matches!(again, Outcome::DoneBefore(before) if before == done));
}

#[test]
fn a_run_of_another_version_is_not_gone_on_with() {
    let (folder, case) = bench(CASE);
    let out = folder.path().join("out");
    run_until(&case, &options(out.clone(), false), |_| true);
    let file = out.join("checkpoint");
    let mut checkpoint = Checkpoint::from_bytes(&fs::read(&file).unwrap()).unwrap();
    checkpoint.version = "0.0.1".to_owned();
    fs::write(&file, checkpoint.to_bytes()).unwrap();
    let mut go_on = |_: RunEvent<'_>| ControlFlow::Continue(());
    let error = run(&case, &[], &options(out, true), &mut go_on).unwrap_err();
    let said = error.to_string();
    assert!(
        said.contains("started by condyle 0.0.1") && said.contains("run the case again"),
        "{said}"
    );
    assert!(!error.is_physics() && error.in_case().is_none());
}

#[test]
fn check_goes_as_far_as_a_run_before_its_first_cycle() {
    let (_folder, case) = bench(CASE);
    assert!(Preview::of(&case, &[], 1).is_ok());
    let apart = "[femur]\nshape = \"sphere\"\nstart_mm = [90.0, 0.0]\n";
    let (_folder, case) = bench(&format!("{apart}{CASE}"));
    let Err(error) = Preview::of(&case, &[], 1) else {
        panic!("it has no file");
    };
    assert!(matches!(error, RunError::Placement { .. }));
    let problem = &error.in_case().expect("it has a place").problems()[0];
    assert_eq!(problem.line_and_column(), Some((3, 12)));
}
