//! A run into a folder: found, built, marched, estimated, written.

use std::path::Path;

use condyle_io::{
    case::{Assignment, Case, SharedBodies},
    config::DataFile,
    results::{Found, ResultsError, ResultsFolder, Summary},
};

use super::{
    error::RunError,
    event::{Listener, Outcome},
    options::RunOptions,
    prepare::changed,
    running::{Run, RunContext, Start},
    written::WrittenRun,
};

/// Runs the case at `case_path`.
///
/// `on_event` hears of everything and may stop the run by breaking; the updates done are then on
/// the disk, and a run with `resume` goes on to the same bytes as one never stopped. A run that
/// cannot start makes no folder, and one that is done is left as it is.
///
/// # Errors
/// A bad case, a folder that cannot be used, or physics that cannot be solved.
pub fn run(
    case_path: &Path,
    options: &RunOptions,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    run_changed(case_path, &[], options, on_event)
}

/// Runs the case at `case_path` with some of its values changed, as [`run`] does.
///
/// # Errors
/// As [`run`], and a change that cannot be made.
pub fn run_changed(
    case_path: &Path,
    changes: &[Assignment],
    options: &RunOptions,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    let case = changed(case_path, changes)?;
    run_read(&case, Some(case_path), options, on_event)
}

/// Runs a case that is read already, as [`run`] does.
///
/// # Errors
/// As [`run`].
pub fn run_case(
    case: &Case,
    options: &RunOptions,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    run_read(case, None, options, on_event)
}

/// Runs a case that was read from `case_path`, if from a file.
fn run_read(
    case: &Case,
    case_path: Option<&Path>,
    options: &RunOptions,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    let inputs_blake3 = case.inputs_blake3().map_err(RunError::Inputs)?;
    let lock = ResultsFolder::lock(&options.out)?;
    let begun = match found(case, case_path, options, &inputs_blake3)? {
        Found::Done(summary) => return done_before(summary, options),
        Found::Checkpoint(checkpoint, spent_s) => Start::Before(checkpoint, spent_s),
        Found::Case | Found::Nothing => Start::Now,
    };
    let means = RunContext {
        threads: options.threads,
        cache: &options.cache,
        bodies: &SharedBodies::default(),
        out: Some(&options.out),
        wear_law: None,
    };
    let is_new = matches!(begun, Start::Now);
    let mut run = Run::begin(case, means, begun, inputs_blake3.clone(), on_event)?;
    let written = if is_new {
        WrittenRun::new(options, lock, inputs_blake3, &run)?
    } else {
        WrittenRun::going_on(options, lock, inputs_blake3, &run)?
    };
    let outcome = run.complete(&mut |run| written.write_update(run), on_event)?;
    if let Outcome::Done(summary) = &outcome {
        written.write_end(summary)?;
    }
    Ok(outcome)
}

/// What the folder holds; an error if a new run cannot be written to it, or with `resume` if there is
/// no run in it.
fn found(
    case: &Case,
    case_path: Option<&Path>,
    options: &RunOptions,
    inputs_blake3: &str,
) -> Result<Found, ResultsError> {
    let out = &options.out;
    if options.resume {
        let cycles = case.march.cycles as f64;
        ResultsFolder::reopen(out, &case.to_toml_in(out), inputs_blake3, cycles)
    } else if options.force {
        let meshes = [case.femur.file(), case.insert.file()];
        let meshes = meshes.into_iter().flatten().map(DataFile::path);
        let read: Vec<&Path> = case_path.into_iter().chain(meshes).collect();
        ResultsFolder::may_be_written_over(out, &read).map(|()| Found::Nothing)
    } else {
        ResultsFolder::free(out).map(|()| Found::Nothing)
    }
}

/// A run that is done already. It may have been stopped before it wrote the page; the same folder gives
/// the same one.
fn done_before(summary: Box<Summary>, options: &RunOptions) -> Result<Outcome, RunError> {
    condyle_report::write_report(&options.out)?;
    ResultsFolder::existing(&options.out).finish()?;
    Ok(Outcome::DoneBefore(summary))
}
