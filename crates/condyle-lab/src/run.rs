//! A case run into a results folder, from the start or from where it was stopped.

use std::{
    io,
    ops::ControlFlow,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use condyle::{
    evolve::{March, MarchError, PlacementError, Progress, UpdateRecord, WearTest},
    machine::CycleError,
};
use condyle_io::{
    cache::Cache,
    case::{BuildError, BuildWarning, Built, Case},
    keyed::Problems,
    results::{ErrorEstimate, Found, ResultsError, ResultsFolder, Summary, SummaryInput},
};
use thiserror::Error;

use crate::accuracy;

/// How a case is run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder for the results.
    pub out: PathBuf,
    /// Go on with the run that is in the folder.
    pub resume: bool,
    /// Threads for the one-time work on a mesh; results do not depend on it.
    pub threads: usize,
    /// Where the one-time work on a mesh is kept for the next run; results do not depend on it.
    pub cache: Cache,
}

/// How far a run has come on the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Updates done.
    pub updates: usize,
    /// Gait cycles done.
    pub cycles: f64,
    /// Gait cycles in all.
    pub of_cycles: f64,
}

impl Reached {
    fn by(march: &March) -> Self {
        Self {
            updates: march.state().updates.len(),
            cycles: march.cycles(),
            of_cycles: march.test().schedule.cycles,
        }
    }
}

/// What happens while a case runs.
#[derive(Clone, Debug)]
pub enum RunEvent<'a> {
    /// Something was put right or looks doubtful.
    Warning(String),
    /// The bodies are placed, or the checkpoint is read.
    Started(Reached),
    /// An increment is solved.
    Solved(Progress),
    /// All updates are done, and an increment is solved to estimate how accurate they are.
    Estimating,
    /// An update is done and on the disk.
    Updated(&'a UpdateRecord),
}

/// How a run ended.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// All cycles are done.
    Done(Box<Summary>),
    /// The folder holds the whole run already; nothing was computed.
    DoneBefore(Box<Summary>),
    /// Somebody asked to stop; what was computed is kept, and can be gone on with.
    Interrupted(Reached),
}

/// Why a run failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The case file.
    #[error(transparent)]
    Case(#[from] Problems),
    /// The bodies that the case describes.
    #[error("{shown}")]
    Build {
        /// Why.
        source: BuildError,
        /// The same at the key of the case that is behind it.
        shown: Problems,
    },
    /// A mesh that went away.
    #[error("a mesh of the case cannot be read: {0}; check the paths in the case")]
    Inputs(#[source] io::Error),
    /// The results folder.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The report.
    #[error(transparent)]
    Report(#[from] condyle_report::ReportError),
    /// Two bodies that make no knee.
    #[error("{shown}")]
    Placement {
        /// Why.
        source: PlacementError,
        /// The same at the key of the case that is behind it.
        shown: Problems,
    },
    /// The physics.
    #[error("{source}; what was computed is kept in {}", out.display())]
    March {
        /// Why.
        source: MarchError,
        /// Where the results so far are.
        out: PathBuf,
    },
}

impl RunError {
    /// Whether the physics could not be solved, rather than the input being wrong.
    pub fn is_physics(&self) -> bool {
        matches!(
            self,
            Self::March { .. }
                | Self::Placement {
                    source: PlacementError::NotSettled { .. },
                    ..
                }
        )
    }

    /// The error with its place in the case file, where it has one.
    pub fn in_case(&self) -> Option<&Problems> {
        match self {
            Self::Case(shown) | Self::Build { shown, .. } | Self::Placement { shown, .. } => {
                Some(shown)
            }
            Self::Inputs(_) | Self::Results(_) | Self::Report(_) | Self::March { .. } => None,
        }
    }
}

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
    on_event: &mut dyn FnMut(RunEvent<'_>) -> ControlFlow<()>,
) -> Result<Outcome, RunError> {
    run_case(&Case::read(case_path)?, options, on_event)
}

/// Runs a case that is read already, as [`run`] does.
///
/// # Errors
/// As [`run`].
pub fn run_case(
    case: &Case,
    options: &RunOptions,
    on_event: &mut dyn FnMut(RunEvent<'_>) -> ControlFlow<()>,
) -> Result<Outcome, RunError> {
    let inputs_blake3 = case.inputs_blake3().map_err(RunError::Inputs)?;
    let found = found(case, options, &inputs_blake3)?;
    if let Found::Done(summary) = found {
        // It may have been stopped before it wrote the page; the same folder gives the same one.
        condyle_report::write_report(&options.out)?;
        ResultsFolder::existing(&options.out).finish()?;
        return Ok(Outcome::DoneBefore(summary));
    }
    let mut clock = Clock::default();
    let built = clock.time(|| build(case, options.threads, &options.cache))?;
    let warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
    for warning in &warnings {
        let _ = on_event(RunEvent::Warning(warning.clone()));
    }
    let side = case.heading.side;
    let (folder, mut march) = match found {
        Found::Checkpoint(checkpoint, spent_s) => {
            clock.spent += Duration::try_from_secs_f64(spent_s).unwrap_or_default();
            let march = clock.time(|| March::resume(built.test, checkpoint.state));
            (ResultsFolder::existing(&options.out), march)
        }
        Found::Case | Found::Nothing | Found::Done(_) => {
            let march = clock.time(|| start(case, built.test))?;
            let folder = ResultsFolder::create(&options.out)?;
            folder.write_case(&case.to_toml())?;
            folder.write_update(&march, side, &inputs_blake3)?;
            folder.write_time_spent(clock.spent.as_secs_f64())?;
            (folder, march)
        }
    };
    let mut stop = on_event(RunEvent::Started(Reached::by(&march)));
    while !march.is_done() {
        if stop.is_break() {
            return Ok(Outcome::Interrupted(Reached::by(&march)));
        }
        let mut watch = |progress| on_event(RunEvent::Solved(progress));
        match clock.time(|| march.update(&mut watch).cloned()) {
            Ok(update) => {
                folder.write_update(&march, side, &inputs_blake3)?;
                folder.write_time_spent(clock.spent.as_secs_f64())?;
                stop = on_event(RunEvent::Updated(&update));
            }
            Err(MarchError::Cycle {
                source: CycleError::Interrupted,
                ..
            }) => stop = ControlFlow::Break(()),
            Err(source) => {
                return Err(RunError::March {
                    source,
                    out: options.out.clone(),
                });
            }
        }
    }
    let mut summary = summary(&march, clock.spent, inputs_blake3, warnings);
    if case.accuracy.estimate {
        let reached = Reached::by(&march);
        let mut watch = || on_event(RunEvent::Estimating);
        let mut clock = Clock::default();
        let Ok(error) = clock.time(|| accuracy::estimate(case, march, &mut watch)) else {
            return Ok(Outcome::Interrupted(reached));
        };
        let wall_s = clock.spent.as_secs_f64();
        summary.error = error.map(|error| ErrorEstimate { wall_s, ..error });
    }
    folder.write_summary(&summary)?;
    condyle_report::write_report(folder.path())?;
    folder.finish()?;
    Ok(Outcome::Done(Box::new(summary)))
}

/// What the folder holds; an error if it is not free, or with `resume` if there is no run in it.
fn found(case: &Case, options: &RunOptions, inputs_blake3: &str) -> Result<Found, ResultsError> {
    if options.resume {
        let cycles = case.march.cycles as f64;
        ResultsFolder::reopen(&options.out, &case.to_toml(), inputs_blake3, cycles)
    } else {
        ResultsFolder::free(&options.out).map(|()| Found::Nothing)
    }
}

/// Checks the case at `case_path` as far as a run would go before its first cycle: the file, the
/// meshes, and that the femur settles on the insert. Gives the case and what was put right.
///
/// # Errors
/// Those of a run that cannot start.
pub fn check(case_path: &Path, threads: usize) -> Result<(Case, Vec<BuildWarning>), RunError> {
    let case = Case::read(case_path)?;
    let built = build(&case, threads, &Cache::off())?;
    start(&case, built.test)?;
    Ok((case, built.warnings))
}

pub(crate) fn build(case: &Case, threads: usize, cache: &Cache) -> Result<Built, RunError> {
    case.build_kept(threads, cache)
        .map_err(|source| RunError::Build {
            shown: case.at_its_key(&source),
            source,
        })
}

pub(crate) fn start(case: &Case, test: WearTest) -> Result<March, RunError> {
    March::start(test).map_err(|source| RunError::Placement {
        shown: case.placement_at_its_key(&source),
        source,
    })
}

fn summary(
    march: &March,
    spent: Duration,
    inputs_blake3: String,
    warnings: Vec<String>,
) -> Summary {
    let test = march.test();
    Summary::new(SummaryInput {
        state: march.state(),
        increments: test.time.increments,
        hexahedra: test.insert.mesh().hexes.len(),
        articulating_nodes: test.insert.surface_nodes().len(),
        wall_s: spent.as_secs_f64(),
        inputs_blake3,
        warnings,
        error: None,
    })
    .expect("a march that is done has an update")
}

/// Time spent on the solver alone.
#[derive(Default)]
struct Clock {
    spent: Duration,
}

impl Clock {
    fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.spent += start.elapsed();
        result
    }
}
