//! Exit codes and errors.

use std::{
    fmt::Display,
    io::{IsTerminal, stderr},
    process::ExitCode,
};

use condyle_io::case::{CaseError, Look};

/// Bad input.
pub const BAD_INPUT: u8 = 2;
/// The physics could not be solved.
pub const PHYSICS: u8 = 3;
/// Interrupted, and resumable.
pub const INTERRUPTED: u8 = 130;

/// Prints an error and gives the exit code.
pub fn fail(error: impl Display, code: u8) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(code)
}

/// Prints all problems of a case file, each with a caret under its place.
pub fn fail_case(error: &CaseError) -> ExitCode {
    let look = match stderr().is_terminal() {
        true => Look::Terminal { width: 100 },
        false => Look::Plain,
    };
    eprint!("{}", error.render(look));
    ExitCode::from(BAD_INPUT)
}
