//! The numbers of summary.json with their units and meanings.

use serde::Serialize;
use serde_json::Value;

use crate::number::{fixed, significant};
use crate::results::{contents::Results, summary::Summary};

/// A number that the report knows: name in the summary, label, unit, digits, meaning.
struct Known {
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    meaning: &'static str,
}

/// Numbers under one heading.
#[derive(Serialize)]
pub(super) struct Group {
    heading: &'static str,
    rows: Vec<Listed>,
}

/// A number as it stands in the list.
#[derive(Serialize)]
struct Listed {
    label: String,
    value: String,
    unit: &'static str,
    meaning: &'static str,
}

/// A number in large type.
#[derive(Serialize)]
pub(super) struct Tile {
    label: &'static str,
    value: String,
    unit: &'static str,
}

const fn known(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    meaning: &'static str,
) -> Known {
    Known {
        key,
        label,
        unit,
        meaning,
    }
}

const GROUPS: [(&str, &[Known]); 4] = [
    (
        "Wear",
        &[
            known(
                "cycles",
                "Cycles",
                "",
                "Gait cycles that the insert has gone through.",
            ),
            known(
                "mass_loss_mg",
                "Mass loss",
                "mg",
                "Volume loss from depth times the density of the material.",
            ),
            known(
                "volume_loss_mm3",
                "Volume loss, from depth",
                "mm\u{b3}",
                "Wear depth summed over the articulating surface.",
            ),
            known(
                "volume_loss_mesh_mm3",
                "Volume loss, from the mesh",
                "mm\u{b3}",
                "Volume of the unworn mesh less that of the worn one: a second count of the same thing.",
            ),
            known(
                "max_depth_mm",
                "Maximum wear depth",
                "mm",
                "Depth at the deepest node, along the surface's normal.",
            ),
        ],
    ),
    (
        "Contact",
        &[
            known(
                "peak_pressure_mpa",
                "Peak pressure",
                "MPa",
                "Largest contact pressure anywhere, between the nodes of the mesh too, and at any instant.",
            ),
            known(
                "peak_pressure_cycle",
                "Cycles before that peak",
                "",
                "After how many cycles the cycle with that pressure comes; 0 is the first.",
            ),
            known(
                "first_cycle_peak_pressure_mpa",
                "Peak pressure, first cycle",
                "MPa",
                "Of the unworn insert.",
            ),
            known(
                "last_cycle_peak_pressure_mpa",
                "Peak pressure, last cycle",
                "MPa",
                "Of the last cycle that was solved.",
            ),
            known(
                "peak_contact_area_mm2",
                "Largest contact area",
                "mm\u{b2}",
                "Largest area in contact at any instant, both sides together.",
            ),
            known(
                "peak_contact_area_cycle",
                "Cycles before that area",
                "",
                "After how many cycles the cycle with that area comes; 0 is the first.",
            ),
            known(
                "first_cycle_contact_area_mm2",
                "Largest contact area, first cycle",
                "mm\u{b2}",
                "Of the unworn insert.",
            ),
            known(
                "last_cycle_contact_area_mm2",
                "Largest contact area, last cycle",
                "mm\u{b2}",
                "Of the last cycle that was solved.",
            ),
            known(
                "last_cycle",
                "Cycles before the last one solved",
                "",
                "The last interval of the march is worn by that cycle.",
            ),
            known(
                "medial_load_share",
                "Medial share of the load",
                "%",
                "Medial force over total force, averaged over the cycle.",
            ),
        ],
    ),
    (
        "Motion",
        &[
            known(
                "ap_range_mm",
                "Anterior\u{2013}posterior range",
                "mm",
                "Largest less smallest position of the insert within a cycle.",
            ),
            known(
                "ie_range_deg",
                "Internal\u{2013}external range",
                "degrees",
                "Largest less smallest rotation of the insert within a cycle.",
            ),
        ],
    ),
    (
        "Computation",
        &[
            known(
                "updates",
                "Updates of the shape",
                "",
                "How often the surface was moved by the wear so far.",
            ),
            known(
                "increments",
                "Increments a cycle",
                "",
                "Steps in time that a gait cycle is cut into.",
            ),
            known(
                "newton_iterations",
                "Newton iterations",
                "",
                "Over the whole run, to bring the forces into balance.",
            ),
            known(
                "contact_evaluations",
                "Contact evaluations",
                "",
                "How often force, moment and tangent of the contact were computed.",
            ),
            known(
                "newton_iterations_per_cycle",
                "Newton iterations a cycle",
                "",
                "Of a cycle solved, on average.",
            ),
            known(
                "contact_evaluations_per_cycle",
                "Contact evaluations a cycle",
                "",
                "Of a cycle solved, on average.",
            ),
            known(
                "explicit_steps",
                "Explicit steps",
                "",
                "Steps of central differences, where the explicit integrator was asked for.",
            ),
            known(
                "added_inertia",
                "Inertia added",
                "",
                "Most inertia added to allow the explicit step asked for, as a part of the machine's own.",
            ),
            known(
                "worst_quality",
                "Worst element quality",
                "",
                "Smallest scaled Jacobian of the worn mesh: 1 is a cube, 0 is flat, below 0 is inverted.",
            ),
        ],
    ),
];

/// Told elsewhere on the page, or different from run to run.
const NOT_LISTED: [&str; 3] = ["wall_s", "version", "hash"];

/// The numbers that matter most.
pub(super) fn tiles(results: &Results) -> Vec<Tile> {
    let Some(summary) = &results.summary else {
        return Vec::new();
    };
    let named = [
        ("mass_loss_mg", "Mass loss"),
        ("max_depth_mm", "Maximum depth"),
        ("peak_pressure_mpa", "Peak pressure"),
        ("ap_range_mm", "AP range"),
        ("ie_range_deg", "IE range"),
        ("medial_load_share", "Medial load"),
    ];
    let tile = |(key, label)| {
        let number = known_by(key)?;
        let value = shown(number, summary.number(key)?, 3);
        Some(Tile {
            label,
            value,
            unit: number.unit,
        })
    };
    named.into_iter().filter_map(tile).collect()
}

/// All numbers in groups; what the report does not know comes last under its own name.
pub(super) fn groups(results: &Results) -> Vec<Group> {
    let Some(summary) = &results.summary else {
        return Vec::new();
    };
    let group = |(heading, numbers): &(&'static str, &[Known])| Group {
        heading,
        rows: numbers
            .iter()
            .filter_map(|number| listed(number, summary))
            .collect(),
    };
    let mut groups: Vec<_> = GROUPS.iter().map(group).collect();
    groups.push(Group {
        heading: "Other",
        rows: others(summary),
    });
    groups.retain(|group| !group.rows.is_empty());
    groups
}

fn listed(number: &Known, summary: &Summary) -> Option<Listed> {
    let value = shown(number, summary.number(number.key)?, 4);
    let label = number.label.to_owned();
    Some(Listed {
        label,
        value,
        unit: number.unit,
        meaning: number.meaning,
    })
}

fn others(summary: &Summary) -> Vec<Listed> {
    summary
        .entries()
        .filter(|(key, _)| known_by(key).is_none())
        .filter(|(key, _)| !NOT_LISTED.iter().any(|hidden| key.contains(hidden)))
        .filter_map(|(key, value)| {
            Some(Listed {
                label: key.to_owned(),
                value: plain(value)?,
                unit: "",
                meaning: "",
            })
        })
        .collect()
}

fn known_by(key: &str) -> Option<&'static Known> {
    GROUPS
        .iter()
        .flat_map(|(_, numbers)| *numbers)
        .find(|number| number.key == key)
}

fn shown(number: &Known, value: f64, digits: i32) -> String {
    match (number.key, number.unit) {
        ("medial_load_share", _) => fixed(100.0 * value, 1),
        ("worst_quality", _) => fixed(value, 3),
        (_, "") => fixed(value, 0),
        _ => significant(value, digits),
    }
}

fn plain(value: &Value) -> Option<String> {
    match value {
        Value::Number(number) => Some(number.to_string()),
        Value::String(text) => Some(text.clone()),
        Value::Bool(yes) => Some(String::from(if *yes { "yes" } else { "no" })),
        _ => None,
    }
}
