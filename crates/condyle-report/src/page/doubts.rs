//! What stands before all numbers: why they are to be doubted, and what was said of the bodies.

use serde::Serialize;

use super::{
    accuracy::not_estimated,
    key_words::{first_letter_large, with_powers},
};
use crate::results::contents::Results;

/// Why the numbers are to be doubted, and what to do.
#[derive(Serialize)]
pub(super) struct Doubt {
    message: String,
    advice: String,
}

/// What makes the run doubtful, as the summary says; and errors that it could not estimate.
pub(super) fn doubts(results: &Results) -> Vec<Doubt> {
    let warnings = results
        .summary
        .as_ref()
        .map(|summary| &summary.plausibility);
    let warnings = warnings.into_iter().flatten();
    let doubtful = warnings.map(|warning| Doubt {
        message: ended(&first_letter_large(&warning.message)),
        advice: with_powers(&warning.advice),
    });
    let unknown = not_estimated(results).into_iter().map(|message| Doubt {
        message,
        advice: String::from("The stated discretisation error is without it."),
    });
    doubtful.chain(unknown).collect()
}

/// What was put right or looked doubtful on the way in.
pub(super) fn warnings(results: &Results) -> Vec<String> {
    let warnings = results.summary.iter().flat_map(|summary| &summary.warnings);
    warnings.map(|warning| ended(warning)).collect()
}

fn ended(text: &str) -> String {
    let text = with_powers(text);
    match text.strip_suffix('.') {
        Some(_) => text,
        None => text + ".",
    }
}
