//! The numbers of summary.json with their units and meanings.

use serde::Serialize;
use serde_json::Value;

use super::key_words::in_words;
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
    meaning: String,
}

/// A number in large type.
#[derive(Serialize)]
pub(super) struct Tile {
    label: &'static str,
    value: String,
    unit: &'static str,
    /// Estimated discretisation error, in the unit.
    error: Option<String>,
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

const GROUPS: [(&str, &[Known]); 5] = [
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
                "Volume loss, from depth, times the density of the material.",
            ),
            known(
                "volume_loss_mm3",
                "Volume loss, from depth",
                "mm\u{b3}",
                "Each update's depth times the area that it wore: what mass is counted from.",
            ),
            known(
                "volume_loss_mesh_mm3",
                "Volume loss, from the mesh",
                "mm\u{b3}",
                "Volume of the unworn mesh less that of the worn one: a second count, to check the first.",
            ),
            known(
                "max_depth_mm",
                "Maximum wear depth",
                "mm",
                "Depth at the deepest node, along the surface's normal.",
            ),
            known(
                "wear_over_conventional",
                "Cross-linked over conventional",
                "",
                "What every law of wear, fitted to conventional polyethylene, was multiplied by.",
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
                "Largest contact pressure anywhere, between the nodes of the mesh too, at any instant of any cycle solved.",
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
                "pressure_law_peak_error_percent",
                "Peak pressure off the deformable insert",
                "%",
                "By how much the pressure law, fitted to a deformable insert, misses its peak at most in stance.",
            ),
            known(
                "peak_contact_area_mm2",
                "Largest contact area",
                "mm\u{b2}",
                "Largest area in contact at any instant of any cycle solved, both sides together.",
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
                "Medial part of the axial force over the first cycle, weighted by force.",
            ),
        ],
    ),
    (
        "Below the surface",
        &[
            known(
                "peak_max_shear_mpa",
                "Largest shear stress",
                "MPa",
                "At the centre of an element, where the pressure of a cycle solved is highest.",
            ),
            known(
                "peak_max_shear_depth_mm",
                "How deep that is",
                "mm",
                "Below the surface, to half an element.",
            ),
            known(
                "peak_max_shear_cycle",
                "Cycles before that",
                "",
                "After how many cycles the cycle with that stress comes; 0 is the first.",
            ),
            known(
                "peak_max_shear_percent",
                "When in that cycle",
                "%",
                "Where the pressure of that cycle is highest.",
            ),
            known(
                "peak_von_mises_mpa",
                "Largest von Mises stress",
                "MPa",
                "The same of the equivalent stress.",
            ),
            known(
                "peak_von_mises_depth_mm",
                "How deep that is",
                "mm",
                "Below the surface, to half an element.",
            ),
            known(
                "first_cycle_max_shear_mpa",
                "Largest shear stress, first cycle",
                "MPa",
                "Of the unworn insert.",
            ),
            known(
                "first_cycle_max_shear_depth_mm",
                "How deep that is",
                "mm",
                "Below the surface, to half an element.",
            ),
            known(
                "max_permanent_set_mm",
                "Permanent set",
                "mm",
                "How far the surface has given way for good by yielding, at most; wear is not in it.",
            ),
            known(
                "first_cycle_permanent_set_mm",
                "Permanent set, first cycle",
                "mm",
                "The same after the first cycle that repeats itself.",
            ),
            known(
                "max_plastic_strain",
                "Largest plastic strain",
                "",
                "Accumulated, at a Gauss point.",
            ),
            known(
                "yielded_elements",
                "Elements that have yielded",
                "",
                "Of those above.",
            ),
            known(
                "ratcheting_elements",
                "Elements that yield in every cycle",
                "",
                "By more than a strain of 1e-5 in the last cycle; the others have shaken down.",
            ),
            known(
                "backside_lift_mm",
                "Lift of the backside",
                "mm",
                "How far a place of it lifts off the tray at most.",
            ),
            known(
                "backside_lifted_percent",
                "Backside that lifts",
                "%",
                "The largest part of it at once.",
            ),
            known(
                "backside_slip_mm",
                "Slip of the backside",
                "mm",
                "Longest way of a place along the tray in a cycle while it presses, there and back.",
            ),
            known(
                "backside_lock_force_n",
                "Force on the lock",
                "N",
                "Along the tray, at most; the femur's friction is not in it.",
            ),
            known(
                "backside_lock_moment_nm",
                "Moment on the lock",
                "N m",
                "About the vertical axis, at most.",
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
                "Largest less smallest position of the insert in the first cycle.",
            ),
            known(
                "ie_range_deg",
                "Internal\u{2013}external range",
                "degrees",
                "Largest less smallest rotation of the insert in the first cycle.",
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
                "cycles_solved",
                "Cycles solved",
                "",
                "Each update solves until the motion repeats itself, which takes a little more than a cycle.",
            ),
            known(
                "cycles_not_repeating",
                "Updates that do not repeat",
                "",
                "Updates whose motion did not repeat itself within the tolerance.",
            ),
            known(
                "step_halvings",
                "Steps halved",
                "",
                "Steps in time that were taken in halves, since they did not converge or were not exact enough.",
            ),
            known(
                "hexahedra",
                "Hexahedra",
                "",
                "Elements of the insert's mesh.",
            ),
            known(
                "articulating_nodes",
                "Nodes of the articulating surface",
                "",
                "Where pressure and wear are known.",
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

/// Told elsewhere on the page.
const TOLD_ELSEWHERE: [&str; 6] = [
    "error",
    "warnings",
    "plausibility",
    "wear_laws",
    "activities",
    NEUTRAL,
];
/// Where the femur settled.
const NEUTRAL: &str = "neutral_pose";
/// In names of what is told elsewhere, or differs from run to run.
const NOT_LISTED: [&str; 4] = ["wall_s", "version", "hash", "blake3"];

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
            error: total_error(summary, key),
        })
    };
    named.into_iter().filter_map(tile).collect()
}

/// The estimated discretisation error of a number, where the summary has one.
fn total_error(summary: &Summary, key: &str) -> Option<String> {
    Some(significant(summary.total_error(key)?, 2))
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
    groups.insert(NEUTRAL_PLACE, neutral(summary));
    groups.push(Group {
        heading: "Other",
        rows: others(summary),
    });
    groups.retain(|group| !group.rows.is_empty());
    groups
}

/// Where the neutral pose stands among the groups: after the motion that counts from it.
const NEUTRAL_PLACE: usize = 4;

/// Where the femur stands when AP, ML and IS read zero.
fn neutral(summary: &Summary) -> Group {
    let rows = [
        (
            "Femoral frame's origin: x, y, z",
            ["femoral_origin_mm"].as_slice(),
            "mm",
            "In the insert frame where the femur settles: there AP, ML and IS read zero. x is anterior, y up, z to the right.",
        ),
        (
            "Flexion, internal rotation, varus",
            &["flexion_deg", "ie_deg", "vv_deg"],
            "degrees",
            "Where the femur settles; zero would be parallel frames.",
        ),
    ];
    let row = |(label, keys, unit, meaning): (&str, &[&str], &'static str, &str)| {
        let pose = summary.object(NEUTRAL)?;
        let values = keys.iter().filter_map(|key| pose.get(*key));
        let numbers = values.flat_map(|value| {
            value
                .as_array()
                .map_or(std::slice::from_ref(value), Vec::as_slice)
        });
        let texts: Vec<String> = numbers
            .filter_map(|number| Some(fixed(number.as_f64()?, 3)))
            .collect();
        Some(Listed {
            label: label.to_owned(),
            value: texts.join(", "),
            unit,
            meaning: meaning.to_owned(),
        })
    };
    Group {
        heading: "Neutral position",
        rows: rows.into_iter().filter_map(row).collect(),
    }
}

fn listed(number: &Known, summary: &Summary) -> Option<Listed> {
    let value = shown(number, summary.number(number.key)?, 4);
    Some(Listed {
        label: number.label.to_owned(),
        value,
        unit: number.unit,
        meaning: number.meaning.to_owned(),
    })
}

/// What the report does not know, in the words of its key.
fn others(summary: &Summary) -> Vec<Listed> {
    let unknown = summary
        .entries()
        .filter(|(key, _)| known_by(key).is_none())
        .filter(|(key, _)| !TOLD_ELSEWHERE.contains(key));
    unknown
        .flat_map(|(key, value)| unlisted(key, key, value))
        .collect()
}

/// A value that the report does not know; of an object, each of its entries.
fn unlisted(path: &str, key: &str, value: &Value) -> Vec<Listed> {
    if NOT_LISTED.iter().any(|hidden| key.contains(hidden)) {
        return Vec::new();
    }
    if let Value::Object(entries) = value {
        let entry = |(inner, value): (&String, &Value)| {
            let rows = unlisted(&format!("{path}.{inner}"), inner, value);
            rows.into_iter().map(|row| under(key, row))
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

/// An entry of an object, named after it too.
fn under(key: &str, row: Listed) -> Listed {
    let (group, _) = in_words(key);
    Listed {
        label: format!("{group}: {}", row.label),
        ..row
    }
}

/// What a number of the summary is called, and its unit, in the order of the page; of results, not of the work.
pub(crate) fn results_in_words() -> impl Iterator<Item = (&'static str, &'static str, &'static str)>
{
    const WORK: &str = "Computation";
    let of_results = GROUPS.iter().filter(|(heading, _)| *heading != WORK);
    let numbers = of_results.flat_map(|(_, numbers)| *numbers);
    numbers.map(|number| (number.key, number.label, number.unit))
}

/// The value of a number in its unit, as the page shows it.
pub(crate) fn shown_value(key: &str, value: f64, digits: i32) -> String {
    known_by(key).map_or_else(
        || significant(value, digits),
        |number| shown(number, value, digits),
    )
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
        ("worst_quality" | "added_inertia", _) => fixed(value, 3),
        ("cycles_solved", _) => fixed(value, 1),
        ("max_plastic_strain", _) => fixed(value, 4),
        (_, "") => fixed(value, 0),
        _ => significant(value, digits),
    }
}

fn plain(value: &Value) -> Option<String> {
    match value {
        Value::Number(number) => number.as_f64().map(in_digits),
        Value::String(text) => Some(text.clone()),
        Value::Bool(yes) => Some(String::from(if *yes { "yes" } else { "no" })),
        Value::Array(values) if !values.is_empty() => {
            let texts: Option<Vec<String>> = values.iter().map(plain).collect();
            texts.map(|texts| texts.join(", "))
        }
        Value::Null | Value::Array(_) | Value::Object(_) => None,
    }
}

/// Four digits, but all of a whole number.
fn in_digits(value: f64) -> String {
    if value.fract() == 0.0 {
        return fixed(value, 0);
    }
    significant(value, 4)
}
