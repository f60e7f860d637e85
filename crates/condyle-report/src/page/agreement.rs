//! Whether the files of a folder are of one run, and of this version.

use condyle_results::catalogue::{INCREMENTS, UPDATES};

use crate::results::contents::Results;

/// The version of condyle that makes this page.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Where files contradict each other, or are of another version, a sentence each.
pub(super) fn disagreements(results: &Results) -> Vec<String> {
    [version(results), updates(results), increments(results)]
        .into_iter()
        .flatten()
        .collect()
}

fn version(results: &Results) -> Option<String> {
    let written = &results.summary.as_ref()?.version;
    (!written.is_empty() && written != VERSION).then(|| {
        format!(
            "The run is of condyle {written} and this page of {VERSION}: what that version did not write, or called otherwise, \
             is not on it."
        )
    })
}

fn updates(results: &Results) -> Option<String> {
    let told = results.summary.as_ref()?.get(&UPDATES)?;
    let rows = results.wear.as_ref()?.rows();
    (told != rows as f64).then(|| {
        format!(
            "summary.json tells of {told} updates, and wear.csv has {rows}: one of them is cut short, or of another run."
        )
    })
}

/// Every cycle of kinematics.csv has as many rows as the summary tells of increments.
fn increments(results: &Results) -> Option<String> {
    let told = results.summary.as_ref()?.get(&INCREMENTS)?;
    let cycles = results.kinematics.as_ref()?.column("cycles")?;
    let lengths = cycles.chunk_by(|one, next| one == next).map(<[f64]>::len);
    let wrong = lengths.into_iter().find(|length| *length as f64 != told)?;
    Some(format!(
        "summary.json tells of {told} increments a cycle, and kinematics.csv has a cycle of {wrong}: one of them is cut short, \
         or of another run."
    ))
}
