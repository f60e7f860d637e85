//! Points of a waveform: named, from a CSV file, or in the case itself.

use std::ops::Range;
use std::sync::Arc;

use condyle::machine::{Interpolation, Knot};
use miette::NamedSource;
use toml::Spanned;
use toml::de::DeValue;

use super::super::channel::{CaseChannel, NamedWaveform};
use super::keys::{DEFAULT_WAVEFORM, WaveformSource, ways};
use super::samples::{Choice, Samples, choose_column, column_points, csv_points};
use crate::config::{
    DataFile, KeyReason, Log, Placed, Section, Source, nearest, pairs, quoted_list,
};

/// Points, the places where they stand, and the text these are in; none for the case file.
pub(super) struct Points {
    pub knots: Vec<Knot>,
    pub spans: Vec<Range<usize>>,
    pub source: Option<Source>,
    pub interpolation: Interpolation,
}

/// The points that the table gives, by name, by file or by themselves.
pub(super) fn points(
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
