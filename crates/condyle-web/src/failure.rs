//! Failures, with the messages of the command.

use std::{fmt::Display, io, path::Path};

use condyle_case::config::{Problem, Problems};
use condyle_lab::RunError;
use serde::Serialize;

const BAD_INPUT: u8 = 2;
const PHYSICS: u8 = 3;

/// A failed call.
#[derive(Debug, Serialize)]
pub struct Failure {
    /// The command's own message, with its carets.
    message: String,
    /// Each problem, with its place where it has one.
    problems: Vec<Wrong>,
    #[serde(skip)]
    is_physics: bool,
}

/// One problem.
#[derive(Debug, Serialize)]
struct Wrong {
    message: String,
    advice: Option<String>,
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
}

impl Failure {
    /// Creates a failure without a place.
    pub fn of_words(words: impl Display) -> Self {
        Self {
            message: format!("error: {words}"),
            problems: Vec::new(),
            is_physics: false,
        }
    }

    /// Creates the failure for a file that cannot be read or written.
    pub fn of_file(path: &Path, error: &io::Error) -> Self {
        Self::of_words(format!("{}: {error}", path.display()))
    }

    pub fn exit_code(&self) -> u8 {
        if self.is_physics { PHYSICS } else { BAD_INPUT }
    }
}

impl From<&Problems> for Failure {
    fn from(problems: &Problems) -> Self {
        Self {
            message: problems.to_string(),
            problems: problems.problems().iter().map(Wrong::from).collect(),
            is_physics: false,
        }
    }
}

impl From<&RunError> for Failure {
    fn from(error: &RunError) -> Self {
        let failure = error
            .in_case()
            .map_or_else(|| Self::of_words(error), Self::from);
        Self {
            is_physics: error.is_physics(),
            ..failure
        }
    }
}

impl From<&Problem> for Wrong {
    fn from(problem: &Problem) -> Self {
        let (line, column) = problem.line_and_column().unzip();
        Self {
            message: problem.to_string(),
            advice: problem.advice().map(str::to_owned),
            file: problem.file().map(str::to_owned),
            line,
            column,
        }
    }
}
