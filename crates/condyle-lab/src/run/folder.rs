//! A run into a folder: from the state found in the folder to the written results.

use std::path::Path;

use condyle::geometry::TriangleMesh;
use condyle_case::{
    case::{Assignment, Case, FEMUR_TRIANGLES, SharedBodies},
    config::DataFile,
};
use condyle_mesh::{PICTURE_DEVIATION_MM, coarser};
use condyle_results::{FolderLock, Found, ResultsError, ResultsFolder};

use crate::run::{
    Listener, Outcome, RunOptions,
    error::RunError,
    running::{Run, RunContext},
};

/// Runs the case at `case_path`, with some of its values changed.
///
/// `on_event` receives every event and may stop the run by breaking; the finished updates are then on the disk, and a
/// run with `resume` gives the same bytes as an uninterrupted one. A run that cannot start creates no folder, and a
/// finished run is not changed.
///
/// # Errors
/// A bad case, a change that cannot be made, a folder that cannot be used, or physics that cannot be solved.
pub fn run(
    case_path: &Path,
    changes: &[Assignment],
    options: &RunOptions,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    let case = Case::read_changed(case_path, changes)?;
    run_read(&case, Some(case_path), options, on_event)
}

/// Runs a case that has been read, as [`run`] does.
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
    // Locked before anything is read, so that two runs cannot both find the folder free.
    let lock = ResultsFolder::lock(&options.out)?;
    let checkpoint = match found(case, case_path, options, &inputs_blake3)? {
        Found::Done(summary) => {
            // The run may have been stopped before it wrote the page; the same folder gives the same page.
            finish(&ResultsFolder::existing(&options.out), options)?;
            return Ok(Outcome::DoneBefore(summary));
        }
        Found::Checkpoint(checkpoint, spent_s) => Some((checkpoint, spent_s)),
        Found::Nothing => None,
    };
    let context = RunContext {
        threads: options.threads,
        cache: &options.cache,
        bodies: &SharedBodies::default(),
        out: Some(&options.out),
        wear_law: None,
    };
    let is_fresh = checkpoint.is_none();
    let mut run = Run::begin(case, context, checkpoint, inputs_blake3.clone(), on_event)?;
    let written = WrittenRun::new(options, lock, inputs_blake3, &run, is_fresh)?;
    let outcome = run.complete(&mut |run| written.write_update(run), on_event)?;
    if let Outcome::Done(summary) = &outcome {
        written.folder.write_summary(summary)?;
        finish(&written.folder, options)?;
    }
    Ok(outcome)
}

fn finish(folder: &ResultsFolder, options: &RunOptions) -> Result<(), RunError> {
    if options.report {
        condyle_report::write_report(folder.path())?;
    }
    Ok(folder.finish()?)
}

/// Returns the part of a run that the folder holds; an error if a new run cannot be written to it, or with `resume`
/// if there is no run in it.
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

struct WrittenRun {
    folder: ResultsFolder,
    /// The lock, held until the run ends.
    lock: Option<FolderLock>,
    inputs_blake3: String,
    /// The femur of the frames of the first and last cycle, if the case requests them.
    in_frames: Option<TriangleMesh>,
}

impl WrittenRun {
    /// Starts a new run in its folder, which is created if necessary, or resumes one.
    fn new(
        options: &RunOptions,
        lock: Option<FolderLock>,
        inputs_blake3: String,
        run: &Run<'_>,
        is_fresh: bool,
    ) -> Result<Self, RunError> {
        let in_frames = if run.case.output.cycle_frames {
            // It is written hundreds of times.
            let femur = run.femur_triangles(FEMUR_TRIANGLES)?;
            Some(coarser(&femur, PICTURE_DEVIATION_MM))
        } else {
            None
        };
        let mut written = Self {
            folder: ResultsFolder::existing(&options.out),
            lock,
            inputs_blake3,
            in_frames,
        };
        if is_fresh {
            // Done before the folder is created, so that a femur that cannot be drawn leaves no folder.
            let femur = run.femur_triangles(FEMUR_TRIANGLES)?;
            written.start(run.case, options)?;
            let side = run.case.side_in_frame();
            written.folder.write_femur(&run.march, &femur, side)?;
            written.write_update(run)?;
        }
        Ok(written)
    }

    /// Creates the folder of a new run, locks it and writes the case.
    fn start(&mut self, case: &Case, options: &RunOptions) -> Result<(), ResultsError> {
        let folder = ResultsFolder::create(&options.out)?;
        if self.lock.is_none() {
            self.lock = ResultsFolder::lock(folder.path())?;
            // Another run may have created the folder since the check.
            ResultsFolder::free(folder.path())?;
        }
        if options.force {
            folder.clear()?;
        }
        folder.write_case(&case.to_toml_in(folder.path()))
    }

    fn write_update(&self, run: &Run<'_>) -> Result<(), RunError> {
        let side = run.case.side_in_frame();
        if let Some(femur) = &self.in_frames {
            self.folder.write_cycles(&run.march, femur, side)?;
        }
        self.folder
            .write_update(&run.march, side, &self.inputs_blake3)?;
        let spent_s = run.spent().as_secs_f64();
        Ok(self.folder.write_time_spent(spent_s)?)
    }
}
