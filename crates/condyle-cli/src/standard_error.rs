//! Words on standard error, which may be closed.

use std::{
    fmt::Display,
    io::{self, Write},
};

/// Says `words` on standard error.
pub fn tell(words: impl Display) {
    show(&format!("{words}\n"));
}

/// Shows `text` on standard error as it is. No work is given up because nobody hears of it.
pub fn show(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
