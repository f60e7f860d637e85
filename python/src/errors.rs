//! Errors as the exceptions of `condyle.errors`, with the command's text and their fields.

use std::fmt::Display;

use condyle_case::config::{Problem, Problems};
use condyle_lab::{Reached, RunError};
use condyle_study::StudyError;
use pyo3::prelude::*;
use pyo3::types::PyList;

/// Something wrong with what was given, without a place in a file.
pub fn bad_input(message: &impl Display) -> PyErr {
    raised("BadInput", |class| class.call1((message.to_string(),)))
}

/// Everything that is wrong with a file.
pub fn of_problems(problems: &Problems) -> PyErr {
    raised("BadInput", |class| {
        of_kind(class, &problems.to_string(), Some(problems))
    })
}

/// A run that failed.
pub fn of_run(error: &RunError) -> PyErr {
    let class = if error.is_physics() {
        "NotSolved"
    } else {
        "BadInput"
    };
    let message = error.to_string();
    raised(class, |class| {
        of_kind(class, message.trim_end(), error.in_case())
    })
}

/// A study that is not done.
pub fn of_study(error: &StudyError) -> PyErr {
    match error {
        StudyError::Study(problems) => of_problems(problems),
        StudyError::Run(error) => of_run(error),
        other => bad_input(other),
    }
}

/// A study that somebody asked to stop.
pub fn study_interrupted(kept: u64, tests: u64) -> PyErr {
    raised("StudyInterrupted", |class| class.call1((kept, tests)))
}

/// Physics that could not be solved.
pub fn not_solved(message: &impl Display) -> PyErr {
    raised("NotSolved", |class| class.call1((message.to_string(),)))
}

/// A run that somebody asked to stop.
pub fn interrupted(reached: &Reached) -> PyErr {
    let Reached {
        updates,
        cycles,
        of_cycles,
    } = *reached;
    raised("Interrupted", |class| {
        class.call1((updates, cycles, of_cycles))
    })
}

/// The exception that `make` makes of its class in `condyle.errors`, or what went wrong on the way.
fn raised(
    class: &str,
    make: impl for<'py> FnOnce(&Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>>,
) -> PyErr {
    Python::attach(|py| {
        let class = py
            .import("condyle.errors")
            .and_then(|module| module.getattr(class));
        match class.and_then(|class| make(&class)) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    })
}

fn of_kind<'py>(
    class: &Bound<'py, PyAny>,
    message: &str,
    problems: Option<&Problems>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = class.py();
    let problem_class = py.import("condyle.errors")?.getattr("Problem")?;
    let listed = PyList::empty(py);
    for problem in problems.map_or(&[][..], Problems::problems) {
        listed.append(as_python(&problem_class, problem)?)?;
    }
    class.call1((message, listed.to_tuple()))
}

fn as_python<'py>(class: &Bound<'py, PyAny>, problem: &Problem) -> PyResult<Bound<'py, PyAny>> {
    let (line, column) = problem.line_and_column().unzip();
    let reason = problem.to_string();
    class.call1((
        reason,
        problem.reason.advice(),
        problem.key(),
        problem.file(),
        line,
        column,
    ))
}
