//! Smallest and largest value of each channel, and when.

use serde::Serialize;

use super::channels::{CHANNELS, Cycle, first_and_last};
use crate::number::{fixed, significant};
use crate::results::{Results, Table};

/// A row of the table of ranges.
#[derive(Serialize)]
pub(super) struct Row {
    name: &'static str,
    unit: &'static str,
    /// One entry a cycle.
    ends: Vec<Range>,
}

#[derive(Serialize)]
struct Range {
    low: String,
    low_percent: String,
    high: String,
    high_percent: String,
}

/// A row a channel that the folder holds.
pub(super) fn rows(results: &Results) -> Vec<Row> {
    let Some(table) = &results.kinematics else {
        return Vec::new();
    };
    let ends = first_and_last(table);
    CHANNELS
        .iter()
        .filter_map(|channel| {
            let values = table.column(channel.column)?;
            let ends = ends
                .iter()
                .map(|cycle| range(table, values, cycle))
                .collect::<Option<_>>()?;
            Some(Row {
                name: channel.title,
                unit: channel.unit,
                ends,
            })
        })
        .collect()
}

fn range(table: &Table, values: &[f64], cycle: &Cycle) -> Option<Range> {
    let percent = table.column("percent")?;
    let finite = || {
        cycle
            .rows
            .iter()
            .copied()
            .filter(|&row| values[row].is_finite())
    };
    let low = finite().min_by(|&a, &b| values[a].total_cmp(&values[b]))?;
    let high = finite().max_by(|&a, &b| values[a].total_cmp(&values[b]))?;
    Some(Range {
        low: significant(values[low], 3),
        low_percent: fixed(percent[low], 0),
        high: significant(values[high], 3),
        high_percent: fixed(percent[high], 0),
    })
}
