//! Checks and runs of a case: in memory for the page, or into a results folder.

use std::{fs, ops::ControlFlow, path::Path};

use condyle_case::{cache::Cache, case::Case};
use condyle_lab::{InMemory, Outcome, Reached, RunError, RunEvent, RunOptions};
use condyle_results::{Directions, Summary};

use crate::{
    failure::Failure,
    message::{Message, send},
    recorder::Recorder,
};

/// Reads the case at `case` and reports all of its problems.
pub fn check(case: &Path) -> Result<(), Failure> {
    read(case).map(|_| ())
}

/// Runs the case at `case` in memory; writes what the page shows into the folder `out`.
pub fn run(case: &Path, out: &Path) -> Result<(), Failure> {
    let case = read(case)?;
    let how = InMemory {
        threads: 1,
        cache: Cache::off(),
        wear_law: None,
    };
    let mut recorder = Recorder::new(case.heading.side);
    let mut reporter = ProgressReporter::of(&case);
    let outcome = condyle_lab::run_in_memory(&case, &how, &mut recorder, &mut |event| {
        reporter.report(&event)
    });
    let summary = done(outcome)?;
    let mut scene = recorder.into_scene(summary.neutral_pose);
    scene.directions = Directions {
        joint: summary.joint,
        side: case.heading.side,
    };
    scene.title = case.heading.title;
    write(out, "scene", &scene.to_bytes())?;
    let json = serde_json::to_vec_pretty(&summary).expect("numbers and text always serialise");
    write(out, "summary.json", &json)
}

/// Runs the case at `case` into the results folder `out`.
pub fn keep(case: &Path, out: &Path) -> Result<(), Failure> {
    let case = read(case)?;
    let options = RunOptions {
        out: out.to_owned(),
        resume: false,
        // The folder is in the memory of the page, which creates it for this run.
        force: true,
        threads: 1,
        cache: Cache::off(),
    };
    let mut reporter = ProgressReporter::of(&case);
    let outcome = condyle_lab::run_case(&case, &options, &mut |event| reporter.report(&event));
    done(outcome).map(|_| ())
}

fn read(case: &Path) -> Result<Case, Failure> {
    Case::read(case).map_err(|problems| Failure::from(&problems))
}

fn done(outcome: Result<Outcome, RunError>) -> Result<Box<Summary>, Failure> {
    match outcome {
        Ok(Outcome::Done(summary) | Outcome::DoneBefore(summary)) => Ok(summary),
        Ok(Outcome::Interrupted(_)) => {
            unreachable!("the page ends the whole program to stop a run")
        }
        Err(error) => Err(Failure::from(&error)),
    }
}

fn write(folder: &Path, name: &str, content: &[u8]) -> Result<(), Failure> {
    let path = folder.join(name);
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(&path, content));
    written.map_err(|error| Failure::of_file(&path, &error))
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
