//! Smallest and largest value of each channel, and when.

use serde::Serialize;

use super::channels::{CHANNELS, Cycle, first_and_last};
use crate::number::{fixed, significant};
use crate::results::{contents::Results, table::Table};

/// The range of a channel in the first and in the last cycle.
#[derive(Serialize)]
pub(super) struct ChannelRange {
    name: &'static str,
    unit: &'static str,
    /// One entry a cycle.
    ends: Vec<CycleRange>,
}

/// Smallest and largest value in one cycle, and where in it.
#[derive(Serialize)]
struct CycleRange {
    low: String,
    low_percent: String,
    high: String,
    high_percent: String,
}

/// The range of every channel that the folder holds.
pub(super) fn ranges(results: &Results) -> Vec<ChannelRange> {
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
            Some(ChannelRange {
                name: channel.title,
                unit: channel.unit,
                ends,
            })
        })
        .collect()
}

fn range(table: &Table, values: &[f64], cycle: &Cycle) -> Option<CycleRange> {
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
    Some(CycleRange {
        low: significant(values[low], 3),
        low_percent: fixed(percent[low], 0),
        high: significant(values[high], 3),
        high_percent: fixed(percent[high], 0),
    })
}
