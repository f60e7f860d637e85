//! The numbers of summary.json, as the catalogue names and describes them.

use condyle_results::{
    Interval, Summary,
    catalogue::{self, Scalar, Section},
};
use serde_json::Value;

use crate::number::{first_letter_large, fixed, in_words, significant, with_powers};
use crate::results::Results;

/// A number at the top of the page.
pub(super) struct Tile {
    pub label: String,
    pub value: String,
    pub unit: String,
    pub interval: Option<String>,
    /// Its discretisation error, in the unit.
    pub error: Option<String>,
}

/// Rows of the table of all numbers under one heading.
pub(super) struct Group {
    pub heading: &'static str,
    pub rows: Vec<Listed>,
}

/// A row of the table of all numbers.
pub(super) struct Listed {
    pub label: String,
    pub value: String,
    pub unit: String,
    pub meaning: String,
}

/// Parts of names of entries that differ from run to run of one case, or that the page shows as its origin.
const NOT_LISTED: [&str; 4] = ["wall_s", "version", "hash", "blake3"];

pub(super) fn tiles(results: &Results) -> Vec<Tile> {
    let Some(summary) = &results.summary else {
        return Vec::new();
    };
    let tile = |number: &'static Scalar| {
        let error = summary.total_error(number);
        let prediction = summary.prediction.as_ref();
        let interval = prediction.and_then(|prediction| {
            let Interval { low, median, high } = prediction.interval(number)?;
            let [low, median, high] = [low, median, high].map(|value| significant(value, 2));
            Some(if prediction.is_of_run {
                format!("90 % of laboratories: {low} to {high}")
            } else {
                format!("calibrated law: {median}; 90 % of laboratories: {low} to {high}")
            })
        });
        Some(Tile {
            label: label_of(number),
            value: shown(number, summary.get(number)?, 3),
            unit: unit_of(number),
            interval,
            error: error.map(|error| significant(error, 2)),
        })
    };
    catalogue::headlines().filter_map(tile).collect()
}

/// Returns all numbers in groups; entries that are not in the catalogue come last under their own names.
pub(super) fn groups(results: &Results) -> Vec<Group> {
    let Some(summary) = &results.summary else {
        return Vec::new();
    };
    let group = |section: &Section| Group {
        heading: section.heading,
        rows: section
            .scalars
            .iter()
            .filter(|number| !is_hidden(number.key))
            .filter_map(|number| {
                let meaning = [number.description(), number.definition()].join(" ");
                Some(Listed {
                    label: label_of(number),
                    value: shown(number, summary.get(number)?, 4),
                    unit: unit_of(number),
                    meaning: with_powers(meaning.trim_end()),
                })
            })
            .collect(),
    };
    let mut groups: Vec<_> = catalogue::SECTIONS.iter().map(group).collect();
    groups.insert(NEUTRAL_PLACE, neutral(summary));
    groups.push(Group {
        heading: "Other",
        rows: others(summary),
    });
    groups.retain(|group| !group.rows.is_empty());
    groups
}

/// The place of the neutral pose among the groups: after the motion, which is relative to it.
const NEUTRAL_PLACE: usize = 4;

/// Returns the pose of the femur at which AP, ML and IS read zero.
fn neutral(summary: &Summary) -> Group {
    let row = |label: &str, values: &[f64], unit: &str, meaning: &str| Listed {
        label: label.to_owned(),
        value: values
            .iter()
            .map(|value| fixed(*value, 3))
            .collect::<Vec<_>>()
            .join(", "),
        unit: unit.to_owned(),
        meaning: meaning.to_owned(),
    };
    let of_knee = summary
        .neutral_pose
        .and_then(|pose| Some((pose, pose.angles?)));
    let rows = of_knee.iter().flat_map(|(pose, angles)| {
        [
            row(
                "Femoral frame's origin: x, y, z",
                &pose.femoral_origin_mm,
                "mm",
                "In the insert frame, with the settled femur: there AP, ML and IS read zero. x is anterior, y up, z to the right.",
            ),
            row(
                "Flexion, internal rotation, varus",
                &[angles.flexion_deg, angles.ie_deg, angles.vv_deg],
                "degrees",
                "Of the settled femur; zero if both frames are parallel.",
            ),
        ]
    });
    Group {
        heading: "Neutral position",
        rows: rows.collect(),
    }
}

pub(crate) fn label_of(number: &Scalar) -> String {
    first_letter_large(number.label)
}

/// Returns the unit that a number is shown in, as it is printed.
pub(crate) fn unit_of(number: &Scalar) -> String {
    with_powers(number.shown_unit())
}

fn is_hidden(key: &str) -> bool {
    NOT_LISTED.iter().any(|hidden| key.contains(hidden))
}

/// Returns the entries that are not in the catalogue, named by their keys.
fn others(summary: &Summary) -> Vec<Listed> {
    let others = summary.others.iter();
    let listed = others.flat_map(|(key, value)| unlisted(key, key, value));
    listed.collect()
}

/// Returns an entry that is not in the catalogue, or each entry of an object.
fn unlisted(path: &str, key: &str, value: &Value) -> Vec<Listed> {
    if is_hidden(key) {
        return Vec::new();
    }
    if let Value::Object(entries) = value {
        let entry = |(inner, value): (&String, &Value)| {
            let rows = unlisted(&format!("{path}.{inner}"), inner, value);
            rows.into_iter().map(|row| Listed {
                label: format!("{}: {}", in_words(key).0, row.label),
                ..row
            })
        };
        return entries.iter().flat_map(entry).collect();
    }
    let (label, unit) = in_words(key);
    let row = plain(value).map(|value| Listed {
        label,
        value,
        unit,
        meaning: format!("In summary.json: {path}"),
    });
    Vec::from_iter(row)
}

/// Formats a number: numbers with a unit span orders of magnitude and get significant digits; counts, shares and
/// ratios get decimals.
pub(crate) fn shown(number: &Scalar, value: f64, digits: i32) -> String {
    let value = number.shown(value);
    if number.unit().is_empty() {
        return fixed(value, number.decimals);
    }
    significant(value, digits)
}

fn plain(value: &Value) -> Option<String> {
    match value {
        Value::Number(number) => number.as_f64().map(|value| match value.fract() {
            0.0 => fixed(value, 0),
            _ => significant(value, 4),
        }),
        Value::String(text) => Some(text.clone()),
        Value::Bool(yes) => Some(String::from(if *yes { "yes" } else { "no" })),
        Value::Array(values) if !values.is_empty() => {
            let texts: Option<Vec<String>> = values.iter().map(plain).collect();
            texts.map(|texts| texts.join(", "))
        }
        Value::Null | Value::Array(_) | Value::Object(_) => None,
    }
}
