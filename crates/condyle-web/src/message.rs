//! Messages to the page while the program runs.

use std::io::{self, Write};

use condyle_lab::Reached;
use serde::Serialize;

use crate::failure::Failure;

/// One line on standard output.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Message {
    /// A correction of the input, or a remark on suspicious input.
    Warning(String),
    /// Progress of a run.
    Reached(Reached),
    /// All updates are done, and their error is being estimated.
    Estimating,
    /// A conclusion about a body.
    Remark(String),
    /// The call failed.
    Failed(Failure),
}

/// Sends a message to the page, which may not be listening.
pub fn send(message: &Message) {
    let line = serde_json::to_string(message).expect("numbers and text always serialise");
    let mut page = io::stdout().lock();
    let _ = writeln!(page, "{line}").and_then(|()| page.flush());
}
