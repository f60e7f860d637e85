//! One test, run.

use std::path::Path;

use condyle_io::{cache::Cache, case::SharedBodies, study::OUTPUTS};

use super::{
    error::StudyError,
    plan::{Plan, Test},
};
use crate::{
    Outcome, RunError, RunEvent, RunOptions,
    run::{marched, run_case},
};
use std::ops::ControlFlow;

/// What a test found: its outputs in the order of [`OUTPUTS`], or why it found nothing.
pub type TestResult = Result<Vec<f64>, String>;

/// What the tests of a study are run with: bodies that do not vary are built once.
pub struct TestBench {
    bodies: SharedBodies,
    cache: Cache,
}

impl TestBench {
    /// Runs a test of a plan. One that fails stops nothing: that is what it found.
    pub fn run(&self, plan: &Plan, test: &Test) -> TestResult {
        let case = plan.case_of(test);
        let summary = case.and_then(|case| marched(&case, &self.cache, &self.bodies));
        let summary = summary.map_err(|error| reason(&error))?;
        Ok(OUTPUTS.iter().map(|output| (output.of)(&summary)).collect())
    }
}

impl Default for TestBench {
    fn default() -> Self {
        let (bodies, cache) = (SharedBodies::default(), Cache::of_user());
        Self { bodies, cache }
    }
}

/// Why a test found nothing, on one line.
fn reason(error: &RunError) -> String {
    let in_case = error
        .in_case()
        .and_then(|problems| problems.problems().first());
    let words = in_case.map_or_else(|| error.to_string(), ToString::to_string);
    words.lines().next().unwrap_or_default().trim().to_owned()
}

impl Plan {
    /// Runs a test into a results folder of its own, as `condyle run` runs a case.
    ///
    /// # Errors
    /// Those of a run.
    pub fn run_into_folder(
        &self,
        test: &Test,
        out: &Path,
        on_event: &mut dyn FnMut(RunEvent<'_>) -> ControlFlow<()>,
    ) -> Result<Outcome, StudyError> {
        let options = RunOptions {
            out: out.to_path_buf(),
            resume: false,
            force: false,
            threads: 1,
            cache: Cache::of_user(),
        };
        let case = self.case_of(test)?;
        Ok(run_case(&case, &options, on_event)?)
    }
}
