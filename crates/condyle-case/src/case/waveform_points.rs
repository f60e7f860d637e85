//! Points of a waveform: in the case file, or in columns of a CSV file.

use std::ops::Range;
use std::sync::Arc;

use condyle::machine::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
use condyle::parameter::unit_of;
use miette::NamedSource;
use toml::Spanned;
use toml::de::DeValue;

use super::waveform::{
    CaseChannel, DEFAULT_WAVEFORM, InterpolationWord, NamedWaveform, WaveformReason,
    WaveformSource, ways,
};
use crate::config::{
    Cell, ColumnReason, Columns, DataFile, KeyReason, Log, Placed, Section, Settings, Source,
    names, nearest, pairs, plain, quoted_list,
};

/// Reads the waveform of `channel` from its table in `machine`.
pub(crate) fn read(
    channel: CaseChannel,
    machine: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<Waveform> {
    let section = machine.table(channel.name(), log);
    check_names(channel, &section, log);
    let source = WaveformSource::read(&section, log)?;
    let points = points(channel, &section, &source, log)?;
    finish(channel, &section, &source, points, log)
}

fn check_names(channel: CaseChannel, section: &Section<'_>, log: &mut Log<'_>) {
    let mut known: Vec<&str> = names(&WaveformSource::keys()).collect();
    known.push(channel.knots_key());
    section.check_keys(&known, log);
}

/// Points, the places where they stand, and the text these are in; none for the case file.
struct Points {
    knots: Vec<Knot>,
    spans: Vec<Range<usize>>,
    source: Option<Source>,
    interpolation: Interpolation,
}

/// The points that the table gives, by name, by file or by themselves.
fn points(
    channel: CaseChannel,
    section: &Section<'_>,
    source: &WaveformSource,
    log: &mut Log<'_>,
) -> Option<Points> {
    let ways = ways(channel);
    let given: Vec<&str> = ways
        .into_iter()
        .filter(|way| section.value(way).is_some())
        .collect();
    if let [first, second, ..] = given[..] {
        let reason = KeyReason::Both {
            section: section.name(),
            first: first.to_owned(),
            second: second.to_owned(),
        };
        log.problem(section.key_span(second), reason);
        return None;
    }
    if let (Some(_), None) = (&source.column, &source.file) {
        let (key, needs) = ("column".to_owned(), "`file`".to_owned());
        log.problem(section.key_span("column"), KeyReason::Idle { key, needs });
    }
    match (&source.file, section.value(channel.knots_key())) {
        (Some(file), _) => from_file(channel, section, file, source.column.as_deref(), log),
        (None, Some(value)) => inline(channel, value, log),
        (None, None) if section.is_given() && source.waveform.is_none() => {
            let (section_name, keys) = (section.name(), format!("`{}`", ways.join("`, `")));
            let reason = KeyReason::NoneOf {
                section: section_name,
                keys,
            };
            log.problem(section.span(), reason);
            None
        }
        (None, None) => by_name(channel, section, source.waveform.as_deref(), log),
    }
}

fn by_name(
    channel: CaseChannel,
    section: &Section<'_>,
    word: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Points> {
    let word = word.unwrap_or(DEFAULT_WAVEFORM);
    let named = channel.named();
    let Some(shipped) = named.iter().find(|named| named.word == word) else {
        let words = channel.words();
        let reason = KeyReason::UnknownWord {
            key: "waveform".to_owned(),
            word: word.to_owned(),
            near: nearest(word, words.iter().copied()),
            words: quoted_list(&words),
        };
        log.problem(section.value_span("waveform"), reason);
        return None;
    };
    let mut points = shipped_points(channel, shipped, log)?;
    points.interpolation = shipped.interpolation;
    Some(points)
}

fn shipped_points(
    channel: CaseChannel,
    named: &NamedWaveform,
    log: &mut Log<'_>,
) -> Option<Points> {
    let source = Arc::new(NamedSource::new(named.file, named.text.to_owned()));
    let read = match named.word {
        "none" => column_points(named.text, 1),
        _ => csv_points(channel, named.text, named.file, None),
    };
    logged(read, source, log)
}

fn from_file(
    channel: CaseChannel,
    section: &Section<'_>,
    file: &DataFile,
    column: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Points> {
    let source = file.source(section, "file", log)?;
    let name = file.name();
    let text = source.inner().clone();
    match choose_column(&text, &name, column, channel) {
        Ok(Choice::Column) => logged(csv_points(channel, &text, &name, column), source, log),
        Ok(Choice::InTheCase(reason)) => {
            let key = if column.is_some() { "column" } else { "file" };
            log.problem(section.value_span(key), reason);
            None
        }
        Err(placed) => logged(Err(vec![placed]), source, log),
    }
}

/// Points read from a CSV text, or its problems in `log`.
fn logged(read: Result<Samples, Vec<Placed>>, source: Source, log: &mut Log<'_>) -> Option<Points> {
    let Samples { knots, spans } = log.noted(&source, read)?;
    Some(Points {
        knots,
        spans,
        source: Some(source),
        interpolation: Interpolation::Spline,
    })
}

/// Points that stand in the case file itself.
fn inline(channel: CaseChannel, value: &Spanned<DeValue<'_>>, log: &mut Log<'_>) -> Option<Points> {
    let pairs = pairs(value, channel.knots_key(), log)?;
    let knot = |&([percent, value], _): &([f64; 2], Range<usize>)| Knot { percent, value };
    Some(Points {
        knots: pairs.iter().map(knot).collect(),
        spans: pairs.into_iter().map(|(_, span)| span).collect(),
        source: None,
        interpolation: Interpolation::HalfCosine,
    })
}

/// Samples, and where each stands in its text.
#[derive(Default)]
struct Samples {
    knots: Vec<Knot>,
    spans: Vec<Range<usize>>,
}

/// Whether the case names a column of the file, or what is wrong with what it says.
enum Choice {
    Column,
    InTheCase(ColumnReason),
}

fn choose_column(
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

fn csv_points(
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
fn column_points(text: &str, index: usize) -> Result<Samples, Vec<Placed>> {
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

/// Scales, levels, smooths and joins points.
fn finish(
    channel: CaseChannel,
    section: &Section<'_>,
    source: &WaveformSource,
    points: Points,
    log: &mut Log<'_>,
) -> Option<Waveform> {
    let Points {
        knots,
        spans,
        source: text,
        interpolation,
    } = points;
    match join(source, interpolation, knots) {
        Ok((waveform, placed)) => {
            if let Some((index, reason)) = out_of_range(channel, &placed) {
                let span = spans.get(index).cloned().unwrap_or(0..0);
                log.placed(text.as_ref(), Placed::new(span, reason));
                return None;
            }
            Some(waveform)
        }
        Err((error, placed)) => {
            let index = place_of(&error, &placed);
            let span = spans.get(index).cloned().unwrap_or(section.span());
            let section = section.path().to_owned();
            let reason = WaveformReason { section, error };
            log.placed(text.as_ref(), Placed::new(span, reason));
            None
        }
    }
}

/// The waveform, and the scaled and levelled points it was made from.
fn join(
    source: &WaveformSource,
    interpolation: Interpolation,
    mut knots: Vec<Knot>,
) -> Result<(Waveform, Vec<Knot>), (WaveformError, Vec<Knot>)> {
    for knot in &mut knots {
        knot.value = knot.value * source.scale + source.offset;
    }
    if source.remove_drift {
        knots = without_drift(&knots);
    }
    let given = source.interpolation.map(InterpolationWord::interpolation);
    let chosen = given.unwrap_or(interpolation);
    let waveform =
        Waveform::new(knots.clone(), chosen).and_then(|waveform| match source.low_pass_harmonics {
            Some(harmonics) => Waveform::new(
                low_passed(&waveform, harmonics as usize),
                Interpolation::Spline,
            ),
            None => Ok(waveform),
        });
    match waveform {
        Ok(waveform) => Ok((waveform, knots)),
        Err(error) => Err((error, knots)),
    }
}

/// The first value that the channel cannot have.
fn out_of_range(channel: CaseChannel, knots: &[Knot]) -> Option<(usize, KeyReason)> {
    let limits = channel.limits();
    let index = knots.iter().position(|knot| !limits.allow(knot.value))?;
    let unit = unit_of(channel.knots_key()).unwrap_or_default();
    let reason = KeyReason::OutOfRange {
        key: channel.name().to_owned(),
        value: format!(
            "{} {unit} at {} %",
            plain(knots[index].value),
            knots[index].percent
        ),
        range: format!("{limits} {unit}"),
    };
    Some((index, reason))
}

/// Which point an error is about.
fn place_of(error: &WaveformError, knots: &[Knot]) -> usize {
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
