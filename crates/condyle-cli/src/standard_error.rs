//! Words on standard error, which may be closed.

use std::{
    fmt::Display,
    io::{self, Write},
};

use condyle_case::config::visible;

/// Prints `words` on standard error; they may come from a file or the command line.
pub fn tell(words: impl Display) {
    show(&format!("{}\n", visible(&words.to_string())));
}

/// Prints `text` on standard error as it is. A closed standard error stops no work.
pub fn show(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
