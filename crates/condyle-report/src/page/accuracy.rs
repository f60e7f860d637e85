//! The discretisation errors that a run states, and where they come from.

use serde::Serialize;
use serde_json::{Map, Value};

use crate::number::{fixed, significant};
use crate::results::contents::Results;

/// The table of estimated errors.
#[derive(Serialize)]
pub(super) struct Accuracy {
    rows: Vec<Row>,
    parts: Vec<PartOfError>,
    /// Why parts have no estimate, a sentence each.
    missing: Vec<String>,
}

/// Where an error comes from, and what would take it away.
#[derive(Serialize)]
struct PartOfError {
    name: &'static str,
    meaning: &'static str,
}

/// The errors of a number: its parts and all of them together in %, and that in its unit.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    percents: [String; PARTS.len()],
    in_unit: String,
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

/// Numbers that have an error: name with unit, and the keys of that in % and in the unit.
const NUMBERS: [(&str, &str, &str); 6] = [
    ("Mass loss, mg", "mass_loss_percent", "mass_loss_mg"),
    ("Maximum depth, mm", "max_depth_percent", "max_depth_mm"),
    (
        "Peak pressure, MPa",
        "peak_pressure_percent",
        "peak_pressure_mpa",
    ),
    (
        "Largest contact area, mm\u{b2}",
        "peak_contact_area_percent",
        "peak_contact_area_mm2",
    ),
    ("AP range, mm", "ap_range_percent", "ap_range_mm"),
    ("IE range, degrees", "ie_range_percent", "ie_range_deg"),
];

/// What the summary estimates; none where it estimates nothing.
pub(super) fn accuracy(results: &Results) -> Option<Accuracy> {
    let error = results.summary.as_ref()?.object("error")?;
    let stated = NUMBERS
        .iter()
        .filter(|(_, percent, _)| error.contains_key(*percent));
    let parts = PARTS.iter();
    Some(Accuracy {
        rows: stated.map(|number| row(error, number)).collect(),
        parts: parts
            .map(|&(_, name, meaning)| PartOfError { name, meaning })
            .collect(),
        missing: missing(error),
    })
}

fn row(error: &Map<String, Value>, &(name, percent, in_unit): &(&'static str, &str, &str)) -> Row {
    let shown = |table: &str, part: &str, digits: fn(f64) -> String| {
        let number = error.get(table).and_then(|table| table.get(part)?.as_f64());
        number.map_or_else(|| String::from("unknown"), digits)
    };
    Row {
        name,
        percents: PARTS.map(|(part, ..)| shown(percent, part, |error| fixed(error, 2))),
        in_unit: shown(in_unit, "total", |error| significant(error, 2)),
    }
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
