//! The discretisation errors that a run states, and where they come from.

use serde::Serialize;
use serde_json::{Map, Value};

use super::key_words::in_words;
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
    unit: &'static str,
    values: Vec<String>,
}

/// Parts of the error that the report knows, and what would take them away.
const CURES: [(&str, &str); 4] = [
    ("increments", "finer increments of the gait cycle"),
    ("updates", "more updates of the shape"),
    ("mesh", "shorter edges of the mesh"),
    ("slip_tolerance", "friction that sticks rather than creeps"),
];
/// The root of the sum of squares of all parts.
const TOTAL: &str = "total";

/// What the summary estimates; none where it estimates nothing.
pub(super) fn accuracy(results: &Results) -> Option<Accuracy> {
    let error = results.summary.as_ref()?.object("error")?;
    let parts = parts(error);
    let row = |(key, value): (&String, &Value)| Some(quantity(key, by_parts(value)?, &parts));
    Some(Accuracy {
        rows: error.iter().filter_map(row).collect(),
        parts: parts.iter().map(|part| part_name(part)).collect(),
        cures: cures(),
        missing: not_estimated(results),
    })
}

/// A quantity's error as an object of parts; none of what else stands in the estimate.
fn by_parts(value: &Value) -> Option<&Map<String, Value>> {
    value.as_object().filter(|parts| parts.contains_key(TOTAL))
}

/// The parts that stand in the estimate: those known, others, and together.
fn parts(error: &Map<String, Value>) -> Vec<String> {
    let known = CURES.iter().map(|(part, _)| (*part).to_owned());
    let mut parts: Vec<String> = known.collect();
    for part in error.values().filter_map(by_parts).flat_map(Map::keys) {
        if part != TOTAL && !parts.contains(part) {
            parts.push(part.clone());
        }
    }
    parts.push(TOTAL.to_owned());
    parts
}

fn part_name(part: &str) -> String {
    match part {
        TOTAL => String::from("Together"),
        part => in_words(part).0,
    }
}

fn quantity(key: &str, error: &Map<String, Value>, parts: &[String]) -> QuantityError {
    let (name, unit) = in_words(key);
    let digits = |value: f64| match unit {
        "%" => fixed(value, 2),
        _ => significant(value, 2),
    };
    let shown = |part: &String| {
        let value = error.get(part).and_then(Value::as_f64);
        value.map_or_else(|| String::from("unknown"), digits)
    };
    QuantityError {
        name,
        unit,
        values: parts.iter().map(shown).collect(),
    }
}

fn cures() -> String {
    let cure = |(part, cure): &(&str, &str)| format!("{} with {cure}", part.replace('_', " "));
    let cures: Vec<String> = CURES.iter().map(cure).collect();
    format!("They go away: {}.", cures.join(", "))
}

/// Why parts of the error have no estimate, a sentence each.
pub(super) fn not_estimated(results: &Results) -> Vec<String> {
    let summary = results.summary.as_ref();
    let error = summary.and_then(|summary| summary.object("error"));
    let reasons = error.and_then(|error| error.get("not_estimated")?.as_object());
    let sentence = |(part, why): (&String, &Value)| {
        let (part, why) = (part.replace('_', " "), why.as_str()?);
        Some(format!(
            "The error from {part} could not be estimated: {why}."
        ))
    };
    reasons.into_iter().flatten().filter_map(sentence).collect()
}
