//! A run in progress: into a folder, in memory, or as one of a batch.

use std::{ops::ControlFlow, path::Path, time::Duration};

use condyle::{
    evolve::March,
    geometry::TriangleMesh,
    wear::{FamilyConstants, NamedLaw},
};
use condyle_case::{
    cache::Cache,
    case::{BuildWarning, Case, FEMUR_TRIANGLES, PressureLawChoice, SharedBodies},
};
use condyle_results::{
    CALIBRATED_LAW, Checkpoint, ErrorEstimate, LawWear, NeutralPose, Prediction, Side, Summary,
    catalogue::RunFacts,
};

use crate::run::{
    Clock, Listener, Outcome, Reached, RunEvent,
    error::RunError,
    prepare::{build_sharing, check_so_far, start},
};

/// The surroundings of a run.
#[derive(Clone, Copy)]
pub(crate) struct RunContext<'a> {
    pub threads: usize,
    pub cache: &'a Cache,
    /// Bodies that it may share with other runs.
    pub bodies: &'a SharedBodies,
    /// The results folder, if there is one.
    pub out: Option<&'a Path>,
    /// A law of wear that replaces that of the case.
    pub wear_law: Option<&'a NamedLaw>,
}

pub(crate) struct Run<'a> {
    pub case: &'a Case,
    pub march: March,
    context: RunContext<'a>,
    inputs_blake3: String,
    warnings: Vec<BuildWarning>,
    axes: Option<String>,
    clock: Clock,
}

/// Stores the results of a run after an update.
type Keep<'a, 'b> = dyn FnMut(&Run<'b>) -> Result<(), RunError> + 'a;

impl<'a> Run<'a> {
    /// Builds the bodies and starts the march, or continues from a checkpoint with the solver time so far, s.
    pub fn begin(
        case: &'a Case,
        context: RunContext<'a>,
        checkpoint: Option<(Box<Checkpoint>, f64)>,
        inputs_blake3: String,
        on_event: &mut Listener<'_>,
    ) -> Result<Self, RunError> {
        let mut clock = Clock::default();
        let mut built =
            clock.time(|| build_sharing(case, context.threads, context.cache, context.bodies))?;
        for warning in &built.warnings {
            let _ = on_event(RunEvent::Warning(warning.to_string()));
        }
        if let Some(named) = context.wear_law {
            let cross_linking = &case.material.cross_linking;
            built.test.wear = cross_linking.under(named.clone()).law;
        }
        let march = match checkpoint {
            Some((checkpoint, spent_s)) => {
                // A negative or huge time, from an edited file, counts as zero.
                clock.spent += Duration::try_from_secs_f64(spent_s).unwrap_or_default();
                clock.time(|| March::resume(built.test, checkpoint.state))
            }
            None => clock.time(|| start(case, built.test, &built.warnings))?,
        };
        let _ = on_event(RunEvent::Placed);
        Ok(Self {
            case,
            march,
            context,
            inputs_blake3,
            warnings: built.warnings,
            axes: built.axes,
            clock,
        })
    }

    /// Returns the femur as triangles: those of its mesh, or about `about` triangles.
    pub fn femur_triangles(&self, about: f64) -> Result<TriangleMesh, RunError> {
        let triangles = self.case.femur_triangles(self.march.test(), about);
        triangles.map_err(|source| RunError::of_build(self.case, &source))
    }

    /// Time spent on the solver so far.
    pub fn spent(&self) -> Duration {
        self.clock.spent
    }

    /// Takes updates until all cycles are done or the user stops the run, then returns the results.
    pub fn complete(
        &mut self,
        keep: &mut Keep<'_, 'a>,
        on_event: &mut Listener<'_>,
    ) -> Result<Outcome, RunError> {
        let mut kept_pairs = 0;
        let mut keep_all = |run: &Run<'a>| {
            let (case, test) = (run.case, run.march.test());
            // After every update, so that an interrupted run need not compute the compliance again.
            kept_pairs = case.keep_compliance(test, run.context.cache, kept_pairs);
            keep(run)
        };
        if self.march_on(&mut keep_all, on_event)?.is_continue()
            && let ControlFlow::Continue(summary) = self.summary(on_event)
        {
            return Ok(Outcome::Done(Box::new(summary)));
        }
        Ok(Outcome::Interrupted(Reached::by(&self.march)))
    }

    /// Takes updates until all cycles are done; a break if the user stops the run before.
    fn march_on(
        &mut self,
        keep: &mut Keep<'_, 'a>,
        on_event: &mut Listener<'_>,
    ) -> Result<ControlFlow<()>, RunError> {
        let mut flow = on_event(RunEvent::Started(Reached::by(&self.march)));
        while !self.march.is_done() && flow.is_continue() {
            let (march, clock) = (&mut self.march, &mut self.clock);
            let mut watch = |progress| on_event(RunEvent::Solved(progress));
            let updated = clock.time(|| march.update(&mut watch).map(|flow| flow.is_continue()));
            let is_updated = updated.map_err(|source| RunError::March {
                source: match self.case.side_in_frame() {
                    Side::Left => source.mirrored(),
                    Side::Right => source,
                },
                out: self.context.out.map(Path::to_path_buf),
            })?;
            flow = ControlFlow::Break(());
            if is_updated && let Some(update) = self.march.state().updates.last() {
                keep(self)?;
                // Checked after storing, so that the results so far show the hole.
                check_so_far(self.case, &self.march, &self.warnings)?;
                flow = match self.march.is_done() {
                    // The final cycle is no update.
                    true => ControlFlow::Continue(()),
                    false => on_event(RunEvent::Updated(update)),
                };
            }
        }
        // A stop after the final cycle has no effect.
        if self.march.is_done() {
            flow = ControlFlow::Continue(());
        }
        Ok(flow)
    }

    /// Returns the summary, with its error if the case requests it; a break if the user stops the run.
    fn summary(&self, on_event: &mut Listener<'_>) -> ControlFlow<(), Summary> {
        let mut summary = self.summary_without_error();
        if self.case.accuracy.estimate {
            let mut watch = || on_event(RunEvent::Estimating);
            let mut clock = Clock::default();
            let error = clock
                .time(|| crate::accuracy::estimate(self.case, &self.march, &summary, &mut watch))?;
            summary.error = error.map(|mut error| {
                error.wall_s = clock.spent.as_secs_f64();
                error
            });
        }
        // After the error of the discretisation, which widens the interval.
        summary.prediction = self.prediction(summary.error.as_ref());
        let side = self.case.side_in_frame();
        (summary.plausibility, summary.notes) =
            crate::plausibility::warnings(&self.march, &summary, side, &self.warnings, false);
        ControlFlow::Continue(summary)
    }

    fn summary_without_error(&self) -> Summary {
        let law = self.case.contact.law();
        let facts = RunFacts {
            wall_s: self.clock.spent.as_secs_f64(),
            wear_over_conventional: self.case.material.cross_linking.wear_over_conventional(),
            pressure_law_peak_error_percent: law.and_then(PressureLawChoice::peak_error_percent),
        };
        let mut summary =
            Summary::new(&self.march, facts).expect("a march that is done has an update");
        summary.inputs_blake3.clone_from(&self.inputs_blake3);
        summary.axes.clone_from(&self.axes);
        summary.warnings = self.warnings.iter().map(ToString::to_string).collect();
        summary.neutral_pose = Some(NeutralPose::new(&self.march, self.case.side_in_frame()));
        summary.wear_laws = self.wear_laws();
        summary
    }

    /// Returns the results that laboratories would find for this run.
    fn prediction(&self, error: Option<&ErrorEstimate>) -> Option<Prediction> {
        let wear = &self.case.wear;
        let own = |name| wear.constant(name).ok();
        let is_calibrated = self.context.wear_law.is_none()
            && wear.kind().word == CALIBRATED_LAW
            && own("cross_shear_exponent") == Some(1.0);
        let constants = is_calibrated.then(|| {
            Some(FamilyConstants {
                circle_factor_mm3_per_nm: own("circle_factor_mm3_per_nm")?,
                reference_pressure_mpa: own("reference_pressure_mpa")?,
                pressure_exponent: own("pressure_exponent")?,
                cross_shear_saturation: own("cross_shear_saturation")?,
                line_factor_ratio: own("line_factor_ratio")?,
            })
        });
        let is_of_run = is_calibrated && wear.constants() == wear.kind().defaults();
        Prediction::new(
            &self.march,
            error,
            constants.flatten().filter(FamilyConstants::is_interpolated),
            is_of_run,
            self.case
                .material
                .cross_linking
                .wear_over_conventional()
                .unwrap_or(1.0),
        )
    }

    fn wear_laws(&self) -> Vec<LawWear> {
        let wear = &self.case.wear;
        match &self.context.wear_law {
            // For a law defined by a program it is unknown whether it is approximate.
            Some(named) => LawWear::of(&self.march, named.word, |word| {
                word != named.word && wear.is_approximate(word)
            }),
            None => LawWear::of(&self.march, wear.kind().word, |word| {
                wear.is_approximate(word)
            }),
        }
    }
}

/// Returns the summary of one of many runs that share bodies, without a hash of its inputs and without an error
/// estimate.
pub fn batch_run(case: &Case, cache: &Cache, bodies: &SharedBodies) -> Result<Summary, RunError> {
    let (run, mut summary) = march_watched(case, cache, bodies, &mut |_| ())?;
    (summary.plausibility, summary.notes) = crate::plausibility::warnings(
        &run.march,
        &summary,
        case.side_in_frame(),
        &run.warnings,
        true,
    );
    Ok(summary)
}

/// Returns such a run, finished, and its summary; `watch` receives the march before the first update and
/// after each.
pub(crate) fn march_watched<'a>(
    case: &'a Case,
    cache: &'a Cache,
    bodies: &'a SharedBodies,
    watch: &mut dyn FnMut(&March),
) -> Result<(Run<'a>, Summary), RunError> {
    let context = RunContext {
        threads: 1,
        cache,
        bodies,
        out: None,
        wear_law: None,
    };
    let ignore = &mut |_: RunEvent<'_>| ControlFlow::Continue(());
    let mut run = Run::begin(case, context, None, String::new(), ignore)?;
    watch(&run.march);
    let mut keep = |run: &Run<'_>| {
        watch(&run.march);
        Ok(())
    };
    let _ = run.march_on(&mut keep, ignore)?;
    let mut summary = run.summary_without_error();
    summary.prediction = run.prediction(None);
    Ok((run, summary))
}

/// Options of a run in memory.
#[derive(Clone, Debug)]
pub struct InMemory {
    /// Threads for the one-time work on a mesh; results do not depend on it.
    pub threads: usize,
    /// The cache of the one-time work on a mesh; results do not depend on it.
    pub cache: Cache,
    /// A wear law in place of that of the case; the hash of the inputs does not include it.
    pub wear_law: Option<NamedLaw>,
}

/// Receives the states of a run to be stored.
pub trait RunKeeper {
    /// Called when the femur has settled and nothing is worn; `femur` is its triangulation in the femoral frame: its
    /// own mesh, or about [`FEMUR_TRIANGLES`].
    fn settled(&mut self, march: &March, femur: &TriangleMesh);

    /// Called after every update, and after the final cycle.
    fn updated(&mut self, march: &March);
}

/// Runs a case without writing a file: `keeper` receives the states to be stored. The numbers are those of
/// [`run_case`](crate::run_case).
///
/// # Errors
/// A bad case, or physics that cannot be solved.
pub fn run_in_memory(
    case: &Case,
    how: &InMemory,
    keeper: &mut dyn RunKeeper,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    let inputs_blake3 = case.inputs_blake3().map_err(RunError::Inputs)?;
    let context = RunContext {
        threads: how.threads,
        cache: &how.cache,
        bodies: &SharedBodies::default(),
        out: None,
        wear_law: how.wear_law.as_ref(),
    };
    let mut run = Run::begin(case, context, None, inputs_blake3, on_event)?;
    keeper.settled(&run.march, &run.femur_triangles(FEMUR_TRIANGLES)?);
    let mut keep = |run: &Run<'_>| {
        keeper.updated(&run.march);
        Ok(())
    };
    run.complete(&mut keep, on_event)
}
