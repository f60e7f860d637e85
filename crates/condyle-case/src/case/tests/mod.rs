//! Whole cases: reading, refusals and their messages.

mod activities;
mod changes;
mod errors;
mod files;
mod material;
mod memory;
mod messages;
mod orientation_check;
mod page;
mod rigs;
mod round_trip;
mod wear;

use std::path::{Path, PathBuf};

use condyle::contact::{CycleHistory, Moment, Record};

use super::contents::Case;
use crate::config::Problems;

/// The folder of the cases that come with condyle.
pub(super) fn cases() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases")).to_owned()
}

/// Returns true if the data of subject DM are there; prints that a test is skipped otherwise.
pub(super) fn has_dm_data(test: &str) -> bool {
    let folder = Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/dm-knee"
    ));
    let there = folder.join("fluoroscopy-gait.csv").is_file();
    if !there {
        eprintln!("skipped: {test}: the data of subject DM are not there");
    }
    there
}

/// A cycle of one node that is pressed at one instant.
fn pressed_once(moment: Moment) -> CycleHistory {
    let record = Record {
        node: 0,
        pressed_mm2: 1.0,
        moment,
    };
    let mut history = CycleHistory::default();
    let instant = history.record([record].into_iter());
    history.sort(1, &[instant]);
    history
}

fn parsed(text: &str) -> Result<Case, Problems> {
    Case::parse(text, "case.toml", Path::new(""))
}

/// Returns the problems of a case file with this text, as plain text.
fn refusal(text: &str) -> String {
    match parsed(text) {
        Ok(_) => panic!("this is a good case:\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// Asserts that `shown` has every line of `expected`, in this order.
#[track_caller]
fn assert_shows(shown: &str, expected: &[&str]) {
    let mut rest = shown;
    for line in expected {
        let Some(at) = rest.find(line) else {
            panic!("no {line:?} in\n{rest}\nof\n{shown}");
        };
        rest = &rest[at + line.len()..];
    }
}
