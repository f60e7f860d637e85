//! Samples of a waveform in a CSV file.

use std::ops::Range;

use condyle::machine::Knot;

use super::super::channel::CaseChannel;
use crate::config::{Cell, ColumnReason, Columns, Placed, unit_of};

/// Samples, and where each stands in its text.
#[derive(Default)]
pub(super) struct Samples {
    pub knots: Vec<Knot>,
    pub spans: Vec<Range<usize>>,
}

/// Whether the case names a column of the file, or what is wrong with what it says.
pub(super) enum Choice {
    Column,
    InTheCase(ColumnReason),
}

pub(super) fn choose_column(
    text: &str,
    file: &str,
    column: Option<&str>,
    channel: CaseChannel,
) -> Result<Choice, Placed> {
    let names = Columns::split(text, file, &example(channel))?.names();
    let columns: Vec<String> = names[1..].iter().map(|&name| name.to_owned()).collect();
    let file = file.to_owned();
    Ok(match column {
        Some(column) if !columns.iter().any(|name| name == column) => {
            let column = column.to_owned();
            Choice::InTheCase(ColumnReason::NoColumn {
                column,
                file,
                columns,
            })
        }
        None if columns.len() > 1 => Choice::InTheCase(ColumnReason::WhichColumn { file, columns }),
        _ => Choice::Column,
    })
}

/// A header that would do.
fn example(channel: CaseChannel) -> String {
    format!("percent,{}{}", channel.name(), suffix(channel))
}

/// The unit of a channel as a name ends in it.
fn suffix(channel: CaseChannel) -> &'static str {
    channel.knots_key().trim_start_matches("knots")
}

pub(super) fn csv_points(
    channel: CaseChannel,
    text: &str,
    file: &str,
    column: Option<&str>,
) -> Result<Samples, Vec<Placed>> {
    let columns = Columns::split(text, file, &example(channel)).map_err(|placed| vec![placed])?;
    let names = columns.names();
    let wanted = |name: &&str| Some(*name) == column;
    let index = names.iter().position(wanted).unwrap_or(1);
    let mut problems = Vec::new();
    if !is_percent(names[0]) {
        let column = names[0].to_owned();
        let reason = ColumnReason::NoPercent { column };
        problems.push(Placed::new(columns.name_span(0), reason));
    }
    if header_unit(names[index]) != unit_of(channel.knots_key()) {
        let reason = ColumnReason::OtherUnit {
            column: names[index].to_owned(),
            unit: unit_of(channel.knots_key()).unwrap_or_default(),
            suffix: suffix(channel),
        };
        problems.push(Placed::new(columns.name_span(index), reason));
    }
    if problems.is_empty() {
        column_points(text, index)
    } else {
        Err(problems)
    }
}

/// Percent from the first column and values from column `index`.
pub(super) fn column_points(text: &str, index: usize) -> Result<Samples, Vec<Placed>> {
    let columns = Columns::split(text, "", "").map_err(|placed| vec![placed])?;
    let (percents, values) = match (columns.numbers(0), columns.numbers(index)) {
        (Ok(percents), Ok(values)) => (percents, values),
        (Err(mut one), Err(other)) => {
            one.extend(other);
            return Err(one);
        }
        (Err(problems), _) | (_, Err(problems)) => return Err(problems),
    };
    let knot = |(percent, value): (&Cell, &Cell)| Knot {
        percent: percent.value,
        value: value.value,
    };
    let knots = percents.iter().zip(&values).map(knot).collect();
    let spans = percents.iter().zip(&values);
    let spans = spans.map(|(percent, value)| percent.span.start..value.span.end);
    Ok(Samples {
        knots,
        spans: spans.collect(),
    })
}

fn is_percent(column: &str) -> bool {
    let column = column.to_lowercase();
    ["percent", "pct", "%"]
        .iter()
        .any(|word| column.contains(word))
}

/// The unit in a header such as `ant_mm(xtrans)`: at the end of what stands before a bracket.
fn header_unit(column: &str) -> Option<&'static str> {
    let name = column.split('(').next().unwrap_or_default();
    unit_of(&name.to_lowercase())
}
