//! The discretisation errors that a run states, and where they come from.

use condyle_results::{ErrorParts, Part};
use serde::Serialize;

use super::{
    key_words::{first_letter_large, in_words},
    numbers::unit_of,
};
use crate::number::{fixed, significant};
use crate::results::contents::Results;

/// The table of estimated errors: a row a quantity, a column a part.
#[derive(Serialize)]
pub(super) struct Accuracy {
    parts: Vec<String>,
    rows: Vec<QuantityError>,
    /// What would take the parts away, in a sentence.
    cures: String,
    /// Why parts have no estimate, a sentence each.
    missing: Vec<String>,
}

/// The error of a quantity, by parts.
#[derive(Serialize)]
struct QuantityError {
    name: String,
    unit: String,
    values: Vec<String>,
}

/// The remedy for a part of the error.
fn cure(part: Part) -> &'static str {
    match part {
        Part::Increments => "finer increments of the gait cycle",
        Part::Updates => "more updates of the shape",
        Part::Mesh => "shorter edges of the mesh",
        Part::SlipTolerance => "friction that sticks rather than creeps",
    }
}

/// What the summary estimates; none where it estimates nothing.
pub(super) fn accuracy(results: &Results) -> Option<Accuracy> {
    let error = results.summary.as_ref()?.error.as_ref()?;
    let parts = || {
        ErrorParts::default()
            .parts()
            .into_iter()
            .map(|(part, _)| part)
    };
    let rows = error.quantities().iter().flat_map(|quantity| {
        let name = first_letter_large(quantity.scalar.label);
        [
            row(name.clone(), "%".to_owned(), &quantity.percent),
            row(name, unit_of(quantity.scalar), &quantity.in_unit),
        ]
    });
    let names = parts().map(|part| in_words(part.name()).0);
    let cures = parts().map(|part| format!("{} with {}", in_words_of(part), cure(part)));
    Some(Accuracy {
        rows: rows.collect(),
        parts: names.chain(["Together".to_owned()]).collect(),
        cures: format!("They go away: {}.", cures.collect::<Vec<_>>().join(", ")),
        missing: not_estimated(results),
    })
}

fn in_words_of(part: Part) -> String {
    part.name().replace('_', " ")
}

fn row(name: String, unit: String, error: &ErrorParts) -> QuantityError {
    let digits = |value: f64| match unit.as_str() {
        "%" => fixed(value, 2),
        _ => significant(value, 2),
    };
    let parts = error.parts().into_iter().map(|(_, part)| part);
    let values = parts.chain([Some(error.total)]);
    let values = values.map(|value| value.map_or_else(|| String::from("unknown"), digits));
    QuantityError {
        name,
        values: values.collect(),
        unit,
    }
}

/// Why parts of the error have no estimate, a sentence each.
pub(super) fn not_estimated(results: &Results) -> Vec<String> {
    let error = results
        .summary
        .iter()
        .filter_map(|summary| summary.error.as_ref());
    let reasons = error.flat_map(|error| &error.not_estimated);
    let sentence = |(part, why): (&String, &String)| {
        let part = part.replace('_', " ");
        format!("The error from {part} could not be estimated: {why}.")
    };
    reasons.map(sentence).collect()
}
