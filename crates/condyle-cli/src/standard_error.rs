//! Words on standard error, which may be closed.

use std::{
    fmt::Display,
    io::{self, Write},
};

use condyle_case::config::visible;

/// Says `words` on standard error, which may hold what a file or the command line says.
pub fn tell(words: impl Display) {
    show(&format!("{}\n", visible(&words.to_string())));
}

/// Shows `text` on standard error as it is. No work is given up because nobody hears of it.
pub fn show(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
