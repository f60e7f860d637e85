//! Standard output, which may be closed or on a full disk.

use std::{
    fmt::Display,
    io::{self, ErrorKind, Write},
    path::Path,
    process::ExitCode,
};

use condyle_case::config::visible;
use serde::Serialize;

use crate::exit;

/// Prints `text` on standard output and returns the exit code.
pub fn print(text: &str) -> ExitCode {
    ended(write(text), "")
}

/// Prints `text`, of which more is kept in `folder`, and returns the exit code.
pub fn print_beside(text: &str, folder: &Path) -> ExitCode {
    let kept = format!("; the results are kept in {}", folder.display());
    ended(write(text), &kept)
}

/// Prints a message of the command-line parser, such as its help, and returns the exit code.
pub fn print_from_parser(words: &clap::Error) -> ExitCode {
    match words.print().or_else(forgive_a_closed_pipe) {
        Err(error) if !words.use_stderr() => ended(Err(error), ""),
        Ok(()) | Err(_) => {
            ExitCode::from(u8::try_from(words.exit_code()).unwrap_or(exit::BAD_INPUT))
        }
    }
}

fn write(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.or_else(forgive_a_closed_pipe)
}

/// Ignores the error of a pipe that its reader, such as `head`, has closed.
fn forgive_a_closed_pipe(error: io::Error) -> io::Result<()> {
    match error.kind() {
        // The reader needs no more output.
        ErrorKind::BrokenPipe => Ok(()),
        _ => Err(error),
    }
}

fn ended(written: io::Result<()>, kept: &str) -> ExitCode {
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => exit::fail(
            format!(
                "standard output cannot be written: {error}{kept}; \
                 check that the disk is not full, or send it elsewhere"
            ),
            exit::BAD_INPUT,
        ),
    }
}

/// Returns a result as JSON, with a line end.
pub fn json(result: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(result);
    text.expect("numbers and text always serialise") + "\n"
}

/// Text for standard output, line by line.
#[derive(Default)]
pub struct Lines {
    text: String,
}

impl Lines {
    /// Adds a line; its words may come from a file.
    pub fn line(&mut self, words: impl Display) {
        self.text += &format!("{}\n", visible(&words.to_string()));
    }

    pub fn text(&self) -> &str {
        &self.text
    }
}
