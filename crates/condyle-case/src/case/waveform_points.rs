//! Points of a waveform, in the case file or in columns of a CSV file.

use std::ops::Range;
use std::sync::Arc;

use condyle::machine::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
use condyle::parameter::unit_of;
use miette::NamedSource;

use super::waveform::{CaseChannel, DEFAULT_WAVEFORM, InterpolationWord, WaveformSource};
use crate::config::{
    self, Columns, DataFile, Fault, Log, Placed, Points, Section, Settings, Source, Writer, both,
    idle, no_column, other_unit, plain, unknown_word,
};

/// Reads the waveform of `channel` from its table in `machine`.
pub(super) fn read(
    channel: CaseChannel,
    machine: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<Waveform> {
    let section = machine.table(channel.name(), log);
    let source = WaveformSource::read(&section, log)?;
    let samples = samples(channel, &section, &source, log)?;
    let place = |index: usize| samples.spans.get(index).cloned();
    let text = samples.source.as_ref();
    match join(&source, samples.interpolation, &samples.knots) {
        Ok((waveform, knots)) => match out_of_range(channel, &knots) {
            Some((index, reason)) => {
                log.placed(text, Placed::new(place(index).unwrap_or(0..0), reason));
                None
            }
            None => Some(waveform),
        },
        Err((error, knots)) => {
            let span = place(point_of(&error, &knots)).unwrap_or(section.span());
            let drifts = matches!(error, WaveformError::Seam { .. });
            let advice = if drifts {
                "or, for a measured cycle, set `remove_drift = true`"
            } else {
                ""
            };
            let fault = Fault::new(format!("[{}]: {error}", section.path()), advice);
            log.placed(text, Placed::new(span, fault));
            None
        }
    }
}

/// Writes the table of a waveform, by the default name or by its points.
pub(super) fn write(channel: CaseChannel, waveform: &Waveform, out: &mut Writer) {
    out.comment(channel.about());
    if out.names_waveforms {
        let name = format!("waveform = {DEFAULT_WAVEFORM:?}");
        out.line(&name, "Or file and column, or knots.");
        return;
    }
    let interpolation = InterpolationWord::of(waveform.interpolation()).word();
    let line = format!("interpolation = {interpolation:?}");
    out.line(&line, "From point to point.");
    let unit = unit_of(channel.knots_key()).unwrap_or_default();
    out.comment(&format!("[percent of the cycle, {unit}]"));
    let knots = waveform.knots().iter();
    let pairs: Vec<(f64, f64)> = knots.map(|knot| (knot.percent, knot.value)).collect();
    out.pairs(channel.knots_key(), &pairs);
}

struct Samples {
    knots: Vec<Knot>,
    /// Place of each point in `source`.
    spans: Vec<Range<usize>>,
    /// The text that the points are in; `None` for the case file.
    source: Option<Source>,
    interpolation: Interpolation,
}

/// Reads the points that the table gives by name, by file or directly.
fn samples(
    channel: CaseChannel,
    section: &Section<'_>,
    source: &WaveformSource,
    log: &mut Log<'_>,
) -> Option<Samples> {
    let ways = channel.ways();
    let mut given = ways.into_iter().filter(|way| section.value(way).is_some());
    let (first, second) = (given.next(), given.next());
    if let (Some(first), Some(second)) = (first, second) {
        log.problem(
            section.key_span(second),
            both(&section.name(), first, second),
        );
        return None;
    }
    if source.column.is_some() && source.file.is_none() {
        log.problem(section.key_span("column"), idle("column", "`file`"));
    }
    if let Some(file) = &source.file {
        return from_file(channel, section, file, source.column.as_deref(), log);
    }
    let points: Option<Points> = section.setting(&channel.knots(), Some(None), log)?;
    if let Some(Points(points)) = points {
        let place = |index| section.item_span(channel.knots_key(), index);
        let knot = |&(percent, value): &(f64, f64)| Knot { percent, value };
        return Some(Samples {
            knots: points.iter().map(knot).collect(),
            spans: (0..points.len()).map(place).collect(),
            source: None,
            interpolation: Interpolation::HalfCosine,
        });
    }
    if section.is_given() && source.waveform.is_none() {
        let message = format!("{} needs one of `{}`", section.name(), ways.join("`, `"));
        log.problem(section.span(), Fault::new(message, ""));
        return None;
    }
    by_name(channel, section, source.waveform.as_deref(), log)
}

fn by_name(
    channel: CaseChannel,
    section: &Section<'_>,
    word: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Samples> {
    let word = word.unwrap_or(DEFAULT_WAVEFORM);
    let Some(named) = channel.named().iter().find(|named| named.word == word) else {
        let fault = unknown_word("waveform", word, &channel.words());
        log.problem(section.value_span("waveform"), fault);
        return None;
    };
    let source = Arc::new(NamedSource::new(named.file, named.text.to_owned()));
    let columns = Columns::split(named.text, named.file, "").map_err(|placed| vec![placed]);
    let read = columns.and_then(|columns| column_points(&columns, 1));
    from_text(source, read, named.interpolation, log)
}

fn from_file(
    channel: CaseChannel,
    section: &Section<'_>,
    file: &DataFile,
    column: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Samples> {
    let source = file.source(section, "file", log)?;
    let suffix = channel.knots_key().trim_start_matches("knots");
    let example = format!("percent,{}{suffix}", channel.name());
    let split = Columns::split(source.inner(), &file.name(), &example);
    let columns = log.noted(&source, split.map_err(|placed| vec![placed]))?;
    let names = columns.names();
    let index = match column {
        Some(column) => names.iter().skip(1).position(|name| *name == column),
        None => (names.len() == 2).then_some(0),
    };
    let Some(index) = index.map(|index| index + 1) else {
        let (columns, file) = (&names[1..], file.name());
        let (key, fault) = match column {
            Some(column) => ("column", no_column(column, &file, columns)),
            None => {
                let message =
                    format!("{file} has several columns and the case does not say which to take");
                let advice = format!("add `column = `, one of {}", columns.join(", "));
                ("file", Fault::new(message, advice))
            }
        };
        log.problem(section.value_span(key), fault);
        return None;
    };
    let mut problems = Vec::new();
    if !is_percent(names[0]) {
        let first = names[0];
        let fault = Fault::new(
            format!("the first column must be the percent of the cycle, this one is `{first}`"),
            "name it `percent`, and let it run from 0 to 100",
        );
        problems.push(Placed::new(columns.name_span(0), fault));
    }
    let unit = unit_of(channel.knots_key());
    if header_unit(names[index]) != unit {
        let fault = other_unit(names[index], unit.unwrap_or_default(), suffix);
        problems.push(Placed::new(columns.name_span(index), fault));
    }
    let read = if problems.is_empty() {
        column_points(&columns, index)
    } else {
        Err(problems)
    };
    from_text(Arc::clone(&source), read, Interpolation::Spline, log)
}

type Placements = (Vec<Knot>, Vec<Range<usize>>);

fn from_text(
    source: Source,
    read: Result<Placements, Vec<Placed>>,
    interpolation: Interpolation,
    log: &mut Log<'_>,
) -> Option<Samples> {
    let (knots, spans) = log.noted(&source, read)?;
    Some(Samples {
        knots,
        spans,
        source: Some(source),
        interpolation,
    })
}

/// Reads percent from the first column and values from column `index`.
fn column_points(columns: &Columns<'_>, index: usize) -> Result<Placements, Vec<Placed>> {
    let (percents, values) = match (columns.numbers(0), columns.numbers(index)) {
        (Ok(percents), Ok(values)) => (percents, values),
        (Err(mut one), Err(other)) => {
            one.extend(other);
            return Err(one);
        }
        (Err(problems), _) | (_, Err(problems)) => return Err(problems),
    };
    let rows = percents.iter().zip(&values).map(|(percent, value)| {
        let knot = Knot {
            percent: percent.value,
            value: value.value,
        };
        (knot, percent.span.start..value.span.end)
    });
    Ok(rows.unzip())
}

fn is_percent(column: &str) -> bool {
    let column = column.to_lowercase();
    ["percent", "pct", "%"]
        .iter()
        .any(|word| column.contains(word))
}

/// Returns the unit in a header such as `ant_mm(xtrans)`, which ends what precedes a bracket.
fn header_unit(column: &str) -> Option<&'static str> {
    let name = column.split('(').next().unwrap_or_default();
    unit_of(&name.to_lowercase())
}

/// Returns the waveform, and the scaled and levelled points that it was made from.
fn join(
    source: &WaveformSource,
    interpolation: Interpolation,
    knots: &[Knot],
) -> Result<(Waveform, Vec<Knot>), (WaveformError, Vec<Knot>)> {
    let mut knots = knots.to_vec();
    for knot in &mut knots {
        knot.value = knot.value * source.scale + source.offset;
    }
    if source.remove_drift {
        knots = without_drift(&knots);
    }
    let given = source.interpolation.map(InterpolationWord::interpolation);
    let waveform = Waveform::new(knots.clone(), given.unwrap_or(interpolation));
    let waveform = waveform.and_then(|waveform| match source.low_pass_harmonics {
        Some(harmonics) => {
            let knots = low_passed(&waveform, harmonics as usize);
            Waveform::new(knots, Interpolation::Spline)
        }
        None => Ok(waveform),
    });
    match waveform {
        Ok(waveform) => Ok((waveform, knots)),
        Err(error) => Err((error, knots)),
    }
}

/// Returns the first value outside the channel's range.
fn out_of_range(channel: CaseChannel, knots: &[Knot]) -> Option<(usize, Fault)> {
    let limits = channel.limits();
    let index = knots.iter().position(|knot| !limits.allow(knot.value))?;
    let (knot, unit) = (
        &knots[index],
        unit_of(channel.knots_key()).unwrap_or_default(),
    );
    let value = format!("{} {unit} at {} %", plain(knot.value), knot.percent);
    let fault = config::out_of_range(channel.name(), &value, &format!("{limits} {unit}"));
    Some((index, fault))
}

/// Returns the index of the point at fault.
fn point_of(error: &WaveformError, knots: &[Knot]) -> usize {
    match *error {
        WaveformError::Empty => 0,
        WaveformError::NotFinite { index }
        | WaveformError::OutsideCycle { index, .. }
        | WaveformError::NotIncreasing { index, .. } => index,
        WaveformError::Gap { from, .. } => {
            let at = |knot: &Knot| knot.percent == from;
            knots.iter().position(at).unwrap_or(0)
        }
        WaveformError::Seam { .. } => knots.len() - 1,
    }
}
