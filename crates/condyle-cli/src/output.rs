//! Standard output, which may be closed or on a full disk.

use std::{
    fmt::Display,
    io::{self, ErrorKind, Write},
    path::Path,
    process::ExitCode,
};

use condyle_io::keyed::visible;

use crate::exit;

/// Prints `text` on standard output and gives the exit code.
pub fn print(text: &str) -> ExitCode {
    ended(write(text), "")
}

/// Prints `text`, of which more is kept in `folder`, and gives the exit code.
pub fn print_beside(text: &str, folder: &Path) -> ExitCode {
    let kept = format!("; the results are kept in {}", folder.display());
    ended(write(text), &kept)
}

/// A reader that has gone, as `head` does, has read all that it wanted: that is no error.
fn write(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
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

/// Text for standard output, line by line.
#[derive(Default)]
pub struct Lines {
    text: String,
}

impl Lines {
    /// Adds a line of words, which may hold what a file says.
    pub fn line(&mut self, words: impl Display) {
        self.text += &format!("{}\n", visible(&words.to_string()));
    }

    pub fn text(&self) -> &str {
        &self.text
    }
}
