//! The run itself: found, built, marched, estimated, written.

use std::{ops::ControlFlow, path::Path, time::Duration};

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_io::{
    case::{Assignment, BuildWarning, Case, FEMUR_TRIANGLES, Side},
    keyed::DataFile,
    results::{
        ActivitySummary, Checkpoint, FRAME_TRIANGLES, FolderLock, Found, LawWear, NeutralPose,
        ResultsError, ResultsFolder, Summary, SummaryInput, femur_of_frames,
    },
};

use super::{
    bridged::check_so_far,
    clock::Clock,
    error::RunError,
    event::{Outcome, Reached, RunEvent},
    options::RunOptions,
    prepare::{build, changed, start},
};
use crate::{accuracy, plausibility};

/// Hears of everything that happens, and may stop the run by breaking.
type Listener<'a> = dyn FnMut(RunEvent<'_>) -> ControlFlow<()> + 'a;

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
    let checkpoint = match found(case, case_path, options, &inputs_blake3)? {
        Found::Done(summary) => return done_before(summary, options),
        Found::Checkpoint(checkpoint, spent_s) => Some((*checkpoint, spent_s)),
        Found::Case | Found::Nothing => None,
    };
    let mut run = Run::begin(case, options, checkpoint, lock, inputs_blake3, on_event)?;
    if run.march_on(on_event)?.is_break() {
        return Ok(Outcome::Interrupted(Reached::by(&run.march)));
    }
    let summary = match run.summary(on_event) {
        ControlFlow::Continue(summary) => summary,
        ControlFlow::Break(()) => return Ok(Outcome::Interrupted(Reached::by(&run.march))),
    };
    run.folder.write_summary(&summary)?;
    condyle_report::write_report(run.folder.path())?;
    run.folder.finish()?;
    Ok(Outcome::Done(Box::new(summary)))
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

/// A folder for a new run, with the case in it, and its lock.
fn new_folder(
    case: &Case,
    options: &RunOptions,
    lock: Option<FolderLock>,
) -> Result<(ResultsFolder, Option<FolderLock>), ResultsError> {
    let folder = ResultsFolder::create(&options.out)?;
    let was_there = lock.is_some();
    let lock = lock.map_or_else(|| ResultsFolder::lock(folder.path()), |lock| Ok(Some(lock)))?;
    // Another run may have come first since the folder was found not to be there.
    if !was_there {
        ResultsFolder::free(folder.path())?;
    }
    if options.force {
        folder.clear()?;
    }
    folder.write_case(&case.to_toml_in(folder.path()))?;
    Ok((folder, lock))
}

/// A run that is done already. It may have been stopped before it wrote the page; the same folder gives
/// the same one.
fn done_before(summary: Box<Summary>, options: &RunOptions) -> Result<Outcome, RunError> {
    condyle_report::write_report(&options.out)?;
    ResultsFolder::existing(&options.out).finish()?;
    Ok(Outcome::DoneBefore(summary))
}

/// A run on its way.
struct Run<'a> {
    case: &'a Case,
    options: &'a RunOptions,
    inputs_blake3: String,
    warnings: Vec<BuildWarning>,
    folder: ResultsFolder,
    /// Held until the run has ended.
    _lock: Option<FolderLock>,
    march: March,
    /// The femur that the frames of the first and last cycle show, where the case asks for them.
    in_frames: Option<TriangleMesh>,
    clock: Clock,
}

impl<'a> Run<'a> {
    /// Builds the bodies and starts the march, or goes on from a checkpoint.
    fn begin(
        case: &'a Case,
        options: &'a RunOptions,
        checkpoint: Option<(Checkpoint, f64)>,
        lock: Option<FolderLock>,
        inputs_blake3: String,
        on_event: &mut Listener<'_>,
    ) -> Result<Self, RunError> {
        let mut clock = Clock::default();
        let built = clock.time(|| build(case, options.threads, &options.cache))?;
        for warning in &built.warnings {
            let _ = on_event(RunEvent::Warning(warning.to_string()));
        }
        let is_new = checkpoint.is_none();
        let march = match checkpoint {
            Some((checkpoint, spent_s)) => {
                clock.spent += Duration::try_from_secs_f64(spent_s).unwrap_or_default();
                clock.time(|| March::resume(built.test, checkpoint.state))
            }
            None => clock.time(|| start(case, built.test, &built.warnings))?,
        };
        let drawn = case.output.cycle_frames;
        let in_frames = drawn.then(|| femur_triangles(case, &march, FRAME_TRIANGLES));
        let in_frames = in_frames.transpose()?.map(femur_of_frames);
        let alone = is_new.then(|| femur_triangles(case, &march, FEMUR_TRIANGLES));
        let alone = alone.transpose()?;
        let (folder, lock) = if is_new {
            new_folder(case, options, lock)?
        } else {
            (ResultsFolder::existing(&options.out), lock)
        };
        if let Some(femur) = alone {
            folder.write_femur(&march, &femur, case.heading.side)?;
        }
        let run = Self {
            case,
            options,
            inputs_blake3,
            warnings: built.warnings,
            folder,
            _lock: lock,
            march,
            in_frames,
            clock,
        };
        if is_new {
            run.write_update()?;
        }
        Ok(run)
    }

    /// Updates until all cycles are done; a break if somebody asked to stop before.
    fn march_on(&mut self, on_event: &mut Listener<'_>) -> Result<ControlFlow<()>, RunError> {
        let mut flow = on_event(RunEvent::Started(Reached::by(&self.march)));
        while !self.march.is_done() && flow.is_continue() {
            let (march, clock) = (&mut self.march, &mut self.clock);
            let mut watch = |progress| on_event(RunEvent::Solved(progress));
            let updated = clock.time(|| march.update(&mut watch).map(|flow| flow.is_continue()));
            let is_updated = updated.map_err(|source| RunError::March {
                source,
                out: self.options.out.clone(),
            })?;
            flow = self.updated(is_updated, on_event)?;
        }
        // Whoever stops a run that is done has stopped nothing.
        if self.march.is_done() {
            flow = ControlFlow::Continue(());
        }
        Ok(flow)
    }

    /// Writes an update, and tells of it; a break if there was none.
    fn updated(
        &self,
        is_updated: bool,
        on_event: &mut Listener<'_>,
    ) -> Result<ControlFlow<()>, RunError> {
        let update = self.march.state().updates.last();
        let Some(update) = update.filter(|_| is_updated) else {
            return Ok(ControlFlow::Break(()));
        };
        self.write_update()?;
        check_so_far(self.case, &self.march, &self.warnings)?;
        Ok(on_event(RunEvent::Updated(update)))
    }

    fn write_update(&self) -> Result<(), ResultsError> {
        let side: Side = self.case.heading.side;
        if let Some(femur) = &self.in_frames {
            self.folder.write_cycles(&self.march, femur, side)?;
        }
        self.folder
            .write_update(&self.march, side, &self.inputs_blake3)?;
        self.folder.write_time_spent(self.clock.spent.as_secs_f64())
    }

    /// What the run found, with its error if the case asks for that; a break if somebody asked to stop.
    fn summary(&self, on_event: &mut Listener<'_>) -> ControlFlow<(), Summary> {
        let mut summary = self.summary_without_error();
        if self.case.accuracy.estimate {
            let mut watch = || on_event(RunEvent::Estimating);
            let mut clock = Clock::default();
            let error =
                clock.time(|| accuracy::estimate(self.case, &self.march, &summary, &mut watch))?;
            summary.error = error.map(|mut error| {
                error.wall_s = clock.spent.as_secs_f64();
                error
            });
        }
        summary.plausibility = plausibility::warnings(&self.march, &summary);
        ControlFlow::Continue(summary)
    }

    fn summary_without_error(&self) -> Summary {
        Summary::new(SummaryInput {
            state: self.march.state(),
            increments: self.march.test().time.increments,
            hexahedra: self.march.insert().mesh().hexes.len(),
            articulating_nodes: self.march.insert().surface_nodes().len(),
            wall_s: self.clock.spent.as_secs_f64(),
            inputs_blake3: self.inputs_blake3.clone(),
            warnings: self.warnings.iter().map(ToString::to_string).collect(),
            error: None,
            neutral_pose: NeutralPose::of(&self.march, self.case.heading.side),
            wear_laws: LawWear::of(&self.march, &self.case.wear),
            activities: ActivitySummary::of(&self.march),
        })
        .expect("a march that is done has an update")
    }
}

/// The femur as triangles: those of its mesh, or about so many.
fn femur_triangles(case: &Case, march: &March, about: f64) -> Result<TriangleMesh, RunError> {
    case.femur_triangles(march.test(), about)
        .map_err(|source| RunError::of_build(case, source))
}
