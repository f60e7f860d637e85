//! Checks and runs of a case.

use std::{fs, ops::ControlFlow, path::Path};

use condyle_case::{
    cache::Cache,
    case::{Case, Update},
};
use condyle_lab::{Outcome, Reached, RunEvent, RunOptions};
use condyle_report::{Results, scene::Scene};

use crate::{
    failure::Failure,
    message::{Message, send},
};

/// Runs a case into the results folder `out`, without its report.
pub fn run(case: &Case, out: &Path) -> Result<(), Failure> {
    let options = RunOptions {
        out: out.to_owned(),
        resume: false,
        // The folder is in the memory of the page, which creates it for this run.
        force: true,
        threads: 1,
        cache: Cache::off(),
        report: false,
    };
    let mut reporter = ProgressReporter::of(case);
    let outcome = condyle_lab::run_case(case, &options, &mut |event| reporter.report(&event));
    match outcome {
        Ok(Outcome::Done(_) | Outcome::DoneBefore(_)) => Ok(()),
        Ok(Outcome::Interrupted(_)) => {
            unreachable!("the page ends the whole program to stop a run")
        }
        Err(error) => Err(Failure::from(&error)),
    }
}

/// Writes the scene of the results folder `out`.
pub fn draw(out: &Path, scene: &Path) -> Result<(), Failure> {
    let results = Results::read(out).map_err(Failure::of_words)?;
    let bytes = Scene::read(out, &results).to_bytes();
    fs::write(scene, bytes).map_err(|error| Failure::of_file(scene, &error))
}

/// Writes the report of the results folder `out`.
pub fn report(out: &Path) -> Result<(), Failure> {
    let written = condyle_report::write_report(out);
    written.map(|_| ()).map_err(Failure::of_words)
}

/// Reads the case at `case`; the failure has all of its problems.
pub fn read(case: &Path) -> Result<Case, Failure> {
    Case::read(case).map_err(|problems| Failure::from(&problems))
}

/// Increments and updates of a preview: on the default knee, mass and depth are within a few percent of the whole run, in a
/// quarter of its time.
const PREVIEW_INCREMENTS: u64 = 120;
const PREVIEW_UPDATES: u64 = 3;

/// Returns a case that is solved in a fraction of the time, for a preview.
pub fn coarse(mut case: Case) -> Case {
    case.accuracy.estimate = false;
    case.time.increments = case.time.increments.min(PREVIEW_INCREMENTS);
    if let Update::Fixed(fixed) = &mut case.march.update {
        fixed.updates = fixed.updates.min(PREVIEW_UPDATES);
    }
    case
}

/// Reports the progress of a run to the page.
struct ProgressReporter {
    reached: Reached,
    is_estimating: bool,
}

impl ProgressReporter {
    fn of(case: &Case) -> Self {
        let reached = Reached {
            updates: 0,
            cycles: 0.0,
            of_cycles: case.march.cycles as f64,
        };
        Self {
            reached,
            is_estimating: false,
        }
    }

    fn report(&mut self, event: &RunEvent<'_>) -> ControlFlow<()> {
        match event {
            RunEvent::Warning(warning) => send(&Message::Warning(warning.clone())),
            RunEvent::Started(reached) => self.reach(*reached),
            RunEvent::Updated(update) => self.reach(Reached {
                updates: self.reached.updates + 1,
                cycles: update.cycles,
                ..self.reached
            }),
            RunEvent::Estimating if !self.is_estimating => {
                self.is_estimating = true;
                send(&Message::Estimating);
            }
            RunEvent::Placed | RunEvent::Estimating | RunEvent::Solved(_) => {}
        }
        ControlFlow::Continue(())
    }

    fn reach(&mut self, reached: Reached) {
        self.reached = reached;
        send(&Message::Reached(reached));
    }
}
