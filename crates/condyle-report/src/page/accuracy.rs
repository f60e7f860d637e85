//! The discretisation errors that a run states, and where they come from.

use serde::Serialize;
use serde_json::{Map, Value};

use crate::number::{fixed, significant};
use crate::results::contents::Results;

/// The table of estimated errors.
#[derive(Serialize)]
pub(super) struct Accuracy {
    rows: Vec<ErrorPart>,
    /// Why parts have no estimate, a sentence each.
    missing: Vec<String>,
}

/// An error of mass loss and of maximum depth: %, mg, %, mm.
#[derive(Serialize)]
struct ErrorPart {
    name: &'static str,
    values: [String; 4],
    meaning: &'static str,
}

/// Parts of the error: key in the summary, name, and what would take the error away.
const PARTS: [(&str, &str, &str); 5] = [
    (
        "increments",
        "Increments",
        "finer increments of the gait cycle",
    ),
    ("updates", "Updates", "more updates of the shape"),
    ("mesh", "Mesh", "shorter edges of the mesh"),
    (
        "slip_tolerance",
        "Slip tolerance",
        "friction that sticks rather than creeps",
    ),
    ("total", "Together", "root of the sum of squares"),
];

/// What the summary estimates; none where it estimates nothing.
pub(super) fn accuracy(results: &Results) -> Option<Accuracy> {
    let error = results.summary.as_ref()?.object("error")?;
    let part = |(key, name, meaning): &(&'static str, &'static str, &'static str)| ErrorPart {
        name,
        values: values(error, key),
        meaning,
    };
    Some(Accuracy {
        rows: PARTS.iter().map(part).collect(),
        missing: missing(error),
    })
}

fn values(error: &Map<String, Value>, part: &str) -> [String; 4] {
    let number = |quantity: &str| error.get(quantity)?.get(part)?.as_f64();
    let shown = |quantity: &str, digits: fn(f64) -> String| {
        number(quantity).map_or_else(|| String::from("unknown"), digits)
    };
    [
        shown("mass_loss_percent", |percent| fixed(percent, 2)),
        shown("mass_loss_mg", |mass| significant(mass, 2)),
        shown("max_depth_percent", |percent| fixed(percent, 2)),
        shown("max_depth_mm", |depth| significant(depth, 2)),
    ]
}

fn missing(error: &Map<String, Value>) -> Vec<String> {
    let reasons = error.get("not_estimated").and_then(Value::as_object);
    let sentence = |(part, why): (&String, &Value)| {
        let (part, why) = (part.replace('_', " "), why.as_str()?);
        Some(format!(
            "The error from {part} could not be estimated: {why}."
        ))
    };
    reasons.into_iter().flatten().filter_map(sentence).collect()
}
