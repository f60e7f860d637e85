//! Errors as the exceptions of `condyle.errors`, with the command's text and their fields.

use std::fmt::Display;

use condyle_case::config::{Problem, Problems};
use condyle_lab::RunError;
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

/// An instance of the class of that name in `condyle.errors`; if it cannot be made, the reason.
pub fn exception(class: &str, arguments: impl for<'py> PyCallArgs<'py>) -> PyErr {
    Python::attach(|py| {
        let class = py
            .import("condyle.errors")
            .and_then(|module| module.getattr(class));
        class
            .and_then(|class| class.call1(arguments))
            .map_or_else(|error| error, PyErr::from_value)
    })
}

/// The cause, then remedy, key and file, then line and column of a problem.
fn fields(problem: &Problem) -> (String, [Option<String>; 3], Option<(usize, usize)>) {
    let file = problem.file().map(str::to_owned);
    let texts = [
        problem.advice().map(str::to_owned),
        problem.key().map(str::to_owned),
        file,
    ];
    (problem.to_string(), texts, problem.line_and_column())
}
