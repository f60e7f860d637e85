//! Errors as the exceptions of `condyle.errors`, with the command's text and their fields.

use std::fmt::Display;

use condyle_case::config::{Problem, Problems};
use condyle_lab::{Reached, RunError};
use condyle_study::StudyError;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

/// An error in the input that has no place in a file.
pub fn bad_input(message: impl Display) -> PyErr {
    exception("BadInput", (message.to_string(),))
}

/// All problems of one file.
pub fn of_problems(problems: Problems) -> PyErr {
    let fields: Vec<_> = problems.problems().iter().map(fields).collect();
    exception("BadInput", (problems.to_string(), fields))
}

/// A failed run: unsolved physics, or bad input.
pub fn of_run(error: RunError) -> PyErr {
    let class = if error.is_physics() {
        "NotSolved"
    } else {
        "BadInput"
    };
    let problems = error.in_case().map_or(&[][..], Problems::problems);
    let fields: Vec<_> = problems.iter().map(fields).collect();
    exception(class, (error.to_string().trim_end(), fields))
}

/// A failed study.
pub fn of_study(error: StudyError) -> PyErr {
    match error {
        StudyError::Study(problems) => of_problems(problems),
        StudyError::Run(error) => of_run(error),
        other => bad_input(other),
    }
}

/// Physics that could not be solved outside of a run.
pub fn not_solved(message: impl Display) -> PyErr {
    exception("NotSolved", (message.to_string(),))
}

/// A run that was asked to stop.
pub fn interrupted(reached: &Reached) -> PyErr {
    exception(
        "Interrupted",
        (reached.updates, reached.cycles, reached.of_cycles),
    )
}

/// A study that was asked to stop.
pub fn study_interrupted(kept: u64, tests: u64) -> PyErr {
    exception("StudyInterrupted", (kept, tests))
}

/// An instance of the class of that name in `condyle.errors`; if it cannot be made, the reason.
fn exception(class: &str, arguments: impl for<'py> PyCallArgs<'py>) -> PyErr {
    Python::attach(|py| {
        let class = py
            .import("condyle.errors")
            .and_then(|module| module.getattr(class));
        class
            .and_then(|class| class.call1(arguments))
            .map_or_else(|error| error, PyErr::from_value)
    })
}

/// The fields of `condyle.Problem`, in its order.
type ProblemFields = (
    String,
    Option<String>,
    Option<String>,
    Option<String>,
    Option<usize>,
    Option<usize>,
);

fn fields(problem: &Problem) -> ProblemFields {
    let (line, column) = problem.line_and_column().unzip();
    (
        problem.to_string(),
        problem.reason.advice(),
        problem.key().map(Into::into),
        problem.file().map(Into::into),
        line,
        column,
    )
}
