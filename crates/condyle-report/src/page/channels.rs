//! The channels of kinematics.csv, drawn against the cycle.

use super::captions::cycle_caption;
use crate::figure::{Axis, Curve, Panel};
use crate::results::{contents::Results, table::Table};

/// Width and height of a panel, px.
const SIZE: (f64, f64) = (340.0, 206.0);

/// A column of kinematics.csv as people call it.
pub(crate) struct Channel {
    pub(crate) column: &'static str,
    pub(crate) title: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) positive: &'static str,
    from_zero: bool,
    pub(crate) least_span: f64,
}

/// The channel of a column.
pub(crate) fn channel(column: &str) -> Option<&'static Channel> {
    CHANNELS.iter().find(|channel| channel.column == column)
}

pub(super) static CHANNELS: [Channel; 11] = [
    motion("flexion_deg", "Flexion", "degrees", "flexion", 1.0),
    load("axial_force_n", "Axial force", "N", "compression", 10.0),
    motion(
        "ap_mm",
        "Anterior\u{2013}posterior",
        "mm",
        "insert anterior",
        0.5,
    ),
    motion(
        "ie_deg",
        "Internal\u{2013}external",
        "degrees",
        "insert internal",
        0.5,
    ),
    motion("ml_mm", "Medio-lateral", "mm", "insert lateral", 0.5),
    motion(
        "vv_deg",
        "Varus\u{2013}valgus",
        "degrees",
        "insert varus",
        0.5,
    ),
    motion("is_mm", "Superior\u{2013}inferior", "mm", "superior", 0.1),
    load("contact_area_mm2", "Contact area", "mm\u{b2}", "", 1.0),
    load("peak_pressure_mpa", "Peak pressure", "MPa", "", 1.0),
    load("medial_force_n", "Medial force", "N", "", 10.0),
    load("lateral_force_n", "Lateral force", "N", "", 10.0),
];

const fn motion(
    column: &'static str,
    title: &'static str,
    unit: &'static str,
    positive: &'static str,
    least_span: f64,
) -> Channel {
    Channel {
        column,
        title,
        unit,
        positive,
        from_zero: false,
        least_span,
    }
}

const fn load(
    column: &'static str,
    title: &'static str,
    unit: &'static str,
    positive: &'static str,
    least_span: f64,
) -> Channel {
    Channel {
        column,
        title,
        unit,
        positive,
        from_zero: true,
        least_span,
    }
}

/// The rows of one cycle: the number of cycles done before it, and a range of rows.
pub(super) struct Cycle {
    pub(super) count: f64,
    pub(super) rows: Vec<usize>,
}

/// The first and the last cycle of a table; one entry where it holds only one.
pub(super) fn first_and_last(table: &Table) -> Vec<Cycle> {
    let all: Vec<_> = (0..table.rows()).collect();
    let Some(counts) = table.column("cycles") else {
        return vec![Cycle {
            count: 0.0,
            rows: all,
        }];
    };
    let first = counts.iter().copied().fold(f64::INFINITY, f64::min);
    let last = counts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let rows_of = |count: f64| {
        all.iter()
            .copied()
            .filter(|&row| counts[row] == count)
            .collect()
    };
    let mut ends = vec![first, last];
    ends.dedup();
    ends.into_iter()
        .map(|count| Cycle {
            count,
            rows: rows_of(count),
        })
        .collect()
}

/// What the two kinds of curve are, for the caption: (first, last); `None` without two cycles.
pub(super) fn cycle_names(results: &Results) -> Option<(String, String)> {
    let ends = first_and_last(results.kinematics.as_ref()?);
    let [first, last] = ends.as_slice() else {
        return None;
    };
    Some(cycle_caption(first.count, last.count))
}

/// A panel for each channel that the folder holds.
pub(crate) fn panels(results: &Results) -> Vec<Panel> {
    let Some(table) = &results.kinematics else {
        return Vec::new();
    };
    let Some(percent) = table.column("percent") else {
        return Vec::new();
    };
    let ends = first_and_last(table);
    CHANNELS
        .iter()
        .filter_map(|channel| panel(channel, table.column(channel.column)?, percent, &ends))
        .collect()
}

fn panel(channel: &Channel, values: &[f64], percent: &[f64], ends: &[Cycle]) -> Option<Panel> {
    let classes = if ends.len() == 1 {
        ["last"].as_slice()
    } else {
        &["first", "last"]
    };
    let curves: Vec<_> = ends
        .iter()
        .zip(classes)
        .map(|(cycle, &class)| {
            let points = cycle
                .rows
                .iter()
                .map(|&row| (percent[row], values[row]))
                .collect();
            Curve {
                class,
                points,
                dots: false,
                end: None,
            }
        })
        .collect();
    let any = values.iter().any(|value| value.is_finite());
    any.then(|| Panel {
        id: format!("k-{}", channel.column),
        title: channel.title.to_owned(),
        unit: channel.unit.to_owned(),
        positive: channel.positive.to_owned(),
        x: Axis {
            low: 0.0,
            high: 100.0,
            step: 20.0,
        },
        x_marks: Vec::new(),
        x_unit: "%",
        x_title: "",
        size: SIZE,
        from_zero: channel.from_zero,
        least_span: channel.least_span,
        curves,
        desc: format!(
            "{} in {} against percent of the gait cycle; the table of ranges gives its extremes.",
            channel.title, channel.unit
        ),
    })
}
