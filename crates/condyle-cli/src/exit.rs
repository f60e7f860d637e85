//! Exit codes and errors.

use std::{
    fmt::Display,
    io::{IsTerminal, stderr},
    process::ExitCode,
};

use condyle_case::config::{Problems, RenderStyle};
use condyle_lab::RunError;

use crate::standard_error::{show, tell};

/// Bad input.
pub const BAD_INPUT: u8 = 2;
/// The physics could not be solved.
pub const PHYSICS: u8 = 3;
/// Interrupted, and resumable.
pub const INTERRUPTED: u8 = 130;

/// Prints an error and gives the exit code.
pub fn fail(error: impl Display, code: u8) -> ExitCode {
    tell(format_args!("error: {error}"));
    ExitCode::from(code)
}

/// Prints why a run failed, with a caret under its place in the case file where it has one, and
/// gives the exit code.
pub fn fail_run(error: &RunError) -> ExitCode {
    let code = if error.is_physics() {
        PHYSICS
    } else {
        BAD_INPUT
    };
    let Some(in_case) = error.in_case() else {
        return fail(error, code);
    };
    show(&in_case.render(style()));
    ExitCode::from(code)
}

/// Prints what is wrong with a case file, with carets, and gives the exit code.
pub fn fail_case(error: &Problems) -> ExitCode {
    show(&error.render(style()));
    ExitCode::from(BAD_INPUT)
}

fn style() -> RenderStyle {
    if stderr().is_terminal() {
        RenderStyle::Terminal { width: 100 }
    } else {
        RenderStyle::Plain
    }
}
