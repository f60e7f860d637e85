//! The channels of kinematics.csv, drawn against the cycle.

use std::sync::LazyLock;

use condyle_results::{CycleQuantity, JointKind, KNEE};

use super::captions::cycle_caption;
use crate::figure::{Axis, Curve, Panel};
use crate::results::{contents::Results, table::Table};

/// Width and height of a panel, px.
const SIZE: (f64, f64) = (340.0, 206.0);

/// A column of kinematics.csv as people call it.
pub(crate) struct PlottedColumn {
    pub(crate) column: &'static str,
    pub(crate) title: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) positive: &'static str,
    from_zero: bool,
    pub(crate) least_span: f64,
}

/// The channel of a column.
pub(crate) fn channel(column: &str) -> Option<&'static PlottedColumn> {
    CHANNELS.iter().find(|channel| channel.column == column)
}

/// The columns of kinematics.csv, in their order.
pub(super) static CHANNELS: LazyLock<Vec<PlottedColumn>> = LazyLock::new(|| {
    KNEE.columns
        .iter()
        .copied()
        .map(PlottedColumn::of)
        .collect()
});

impl PlottedColumn {
    fn of(quantity: CycleQuantity) -> Self {
        let column = KNEE.column(quantity);
        let from_zero = |title, unit, least_span| Self {
            column,
            title,
            unit,
            positive: "",
            from_zero: true,
            least_span,
        };
        match quantity {
            CycleQuantity::Position(index) => {
                let joint = KNEE.joint(index);
                Self {
                    column,
                    title: joint.title,
                    unit: in_words(joint.kind()),
                    positive: joint.positive,
                    from_zero: false,
                    least_span: joint.least_span,
                }
            }
            CycleQuantity::AxialForce => Self {
                positive: "compression",
                ..from_zero("Axial force", "N", 10.0)
            },
            CycleQuantity::ContactArea => from_zero("Contact area", "mm\u{b2}", 1.0),
            CycleQuantity::PeakPressure => from_zero("Peak pressure", "MPa", 1.0),
            CycleQuantity::RegionForce(region) => from_zero(KNEE.regions[region].title, "N", 10.0),
        }
    }
}

/// The unit of a joint's positions, as people write it.
fn in_words(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Rotation => "degrees",
        JointKind::Translation => "mm",
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

/// A panel for each channel that the folder holds, of the first activity.
pub(crate) fn panels(results: &Results) -> Vec<Panel> {
    let table = results.kinematics.as_ref();
    let mut panels = table.map_or_else(Vec::new, |table| panels_of(table, ""));
    if let Some(measured) = &results.measured_kinematics {
        for panel in &mut panels {
            let mut channels = CHANNELS.iter();
            let channel = channels.find(|channel| panel_id(channel) == panel.id);
            let curve = channel.and_then(|channel| measured_curve(measured, channel.column));
            panel.curves.extend(curve);
        }
    }
    panels
}

fn panel_id(channel: &PlottedColumn) -> String {
    format!("k-{}", channel.column)
}

/// What was measured of a column; a break where nothing was.
fn measured_curve(measured: &Table, column: &str) -> Option<Curve> {
    let (percents, values) = (measured.column("percent")?, measured.column(column)?);
    let points = percents.iter().copied().zip(values.iter().copied());
    Some(Curve {
        class: "specimen",
        points: points.collect(),
        dots: false,
        end: None,
    })
}

/// A panel for each channel of a table, which `activity` tells from those of others on the page.
pub(super) fn panels_of(table: &Table, activity: &str) -> Vec<Panel> {
    let Some(percent) = table.column("percent") else {
        return Vec::new();
    };
    let ends = first_and_last(table);
    CHANNELS
        .iter()
        .filter_map(|channel| panel(channel, table.column(channel.column)?, percent, &ends))
        .map(|panel| Panel {
            id: format!("{}{activity}", panel.id),
            ..panel
        })
        .collect()
}

fn panel(
    channel: &PlottedColumn,
    values: &[f64],
    percent: &[f64],
    ends: &[Cycle],
) -> Option<Panel> {
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
        id: panel_id(channel),
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
        x_title: String::new(),
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
