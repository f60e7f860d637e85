//! From a table such as `[machine.flexion]` to a periodic waveform in the unit of its key.

use std::ops::Range;
use std::sync::Arc;

use condyle::machine::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
use miette::NamedSource;
use toml::Spanned;
use toml::de::DeValue;

use super::channel::{Channel, NamedWaveform};
use super::files::DataFile;
use super::keys::{Key, Settings, choice, plain, settings, split_unit, unit_of, within};
use super::parse::{Log, Others, Section, names};
use super::problems::{Reason, Source};
use super::samples::{Choice, Samples, choose_column, column_points, csv_points};
use super::setting::{number, quoted_list, type_name};
use super::table::{Placed, read_source};
use super::unknown::nearest;

choice! {
    /// How a waveform goes from point to point.
    InterpolationWord {
        /// Half a cosine: flat at every point.
        HalfCosine = "half-cosine",
        /// The periodic cubic spline, for samples.
        Spline = "spline",
    }
}

settings! {
    /// Where a waveform comes from and what is done to it, in this order: scale, offset, drift,
    /// low pass.
    WaveformSource {
        /// Name of a waveform that comes with condyle.
        waveform: Option<String> = None;
        /// CSV file, relative to the case file; first column percent of the cycle.
        file: Option<DataFile> = None;
        /// Which column of the file, by its name in the header, which ends in its unit.
        column: Option<String> = None;
        /// Factor on every value.
        scale: f64 = 1.0, in within(-1e6, 1e6);
        /// Added to every scaled value, in the unit of the waveform.
        offset: f64 = 0.0, in within(-1e6, 1e6);
        /// Spreads the difference between 0 and 100 % over the cycle, for measured cycles.
        remove_drift: bool = false;
        /// Keeps the mean and this many harmonics, for noisy samples.
        low_pass_harmonics: Option<u64> = None, in within(1.0, 50.0);
        /// From point to point; half-cosine, but spline for a file or a low pass.
        interpolation: Option<InterpolationWord> = None;
    }
}

/// The waveform taken where a case gives none.
pub(super) const DEFAULT_WAVEFORM: &str = "iso-like";

/// Points, the places where they stand, and the text these are in; none for the case file.
struct Points {
    knots: Vec<Knot>,
    spans: Vec<Range<usize>>,
    source: Option<Source>,
    interpolation: Interpolation,
}

/// Reads the waveform of `channel` from its table in `machine`.
pub(super) fn read(channel: Channel, machine: &Section<'_>, log: &mut Log<'_>) -> Option<Waveform> {
    let section = machine.table(channel.name(), log);
    check_names(channel, &section, log);
    let source = WaveformSource::read(&section, log)?;
    let points = points(channel, &section, &source, log)?;
    finish(channel, &section, &source, points, log)
}

fn check_names(channel: Channel, section: &Section<'_>, log: &mut Log<'_>) {
    let mut known: Vec<&str> = names(WaveformSource::KEYS).collect();
    known.push(channel.knots_key());
    section.check_keys(&known, &Others::NONE, log);
}

/// The points that the table gives, by name, by file or by themselves.
fn points(
    channel: Channel,
    section: &Section<'_>,
    source: &WaveformSource,
    log: &mut Log<'_>,
) -> Option<Points> {
    let ways = ["waveform", "file", channel.knots_key()];
    let given: Vec<&str> = ways
        .into_iter()
        .filter(|way| section.value(way).is_some())
        .collect();
    if let [first, second, ..] = given[..] {
        let reason = Reason::Both {
            section: section.name(),
            first: first.to_owned(),
            second: second.to_owned(),
        };
        log.problem(section.key_span(second), reason);
        return None;
    }
    if let (Some(_), None) = (&source.column, &source.file) {
        let (key, needs) = ("column".to_owned(), "`file`".to_owned());
        log.problem(section.key_span("column"), Reason::Idle { key, needs });
    }
    match (&source.file, section.value(channel.knots_key())) {
        (Some(file), _) => from_file(channel, section, file, source.column.as_deref(), log),
        (None, Some(value)) => inline(channel, value, log),
        (None, None) if section.is_given() && source.waveform.is_none() => {
            let (section_name, keys) = (section.name(), format!("`{}`", ways.join("`, `")));
            let reason = Reason::NoneOf {
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
    channel: Channel,
    section: &Section<'_>,
    word: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Points> {
    let word = word.unwrap_or(DEFAULT_WAVEFORM);
    let named = channel.named();
    let Some(shipped) = named.iter().find(|named| named.word == word) else {
        let words: Vec<&str> = named.iter().map(|named| named.word).collect();
        let reason = Reason::UnknownWord {
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

fn shipped_points(channel: Channel, named: &NamedWaveform, log: &mut Log<'_>) -> Option<Points> {
    let source = Arc::new(NamedSource::new(named.file, named.text.to_owned()));
    let read = match named.word {
        "none" => column_points(named.text, 1),
        _ => csv_points(channel, named.text, named.file, None),
    };
    logged(read, source, log)
}

fn from_file(
    channel: Channel,
    section: &Section<'_>,
    file: &DataFile,
    column: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Points> {
    let source = match read_source(file.path()) {
        Ok(source) => source,
        Err(reason) => {
            log.problem(section.value_span("file"), reason);
            return None;
        }
    };
    let name = file_name(file);
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

fn file_name(file: &DataFile) -> String {
    let name = file.path().file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Points read from a CSV text, or its problems in `log`.
fn logged(read: Result<Samples, Vec<Placed>>, source: Source, log: &mut Log<'_>) -> Option<Points> {
    match read {
        Ok(Samples { knots, spans }) => Some(Points {
            knots,
            spans,
            source: Some(source),
            interpolation: Interpolation::Spline,
        }),
        Err(problems) => {
            for (span, reason) in problems {
                log.problem_in(&source, span, reason);
            }
            None
        }
    }
}

/// Points that stand in the case file itself.
fn inline(channel: Channel, value: &Spanned<DeValue<'_>>, log: &mut Log<'_>) -> Option<Points> {
    let pairs = pairs(value, channel.knots_key(), log)?;
    let knot = |&([percent, value], _): &([f64; 2], Range<usize>)| Knot { percent, value };
    Some(Points {
        knots: pairs.iter().map(knot).collect(),
        spans: pairs.into_iter().map(|(_, span)| span).collect(),
        source: None,
        interpolation: Interpolation::HalfCosine,
    })
}

/// A list of pairs of numbers with their places, or everything in it that is none.
pub(super) fn pairs(
    value: &Spanned<DeValue<'_>>,
    key: &str,
    log: &mut Log<'_>,
) -> Option<Vec<([f64; 2], Range<usize>)>> {
    let mut wrong = |value: &Spanned<DeValue<'_>>, wanted: &str| {
        let reason = Reason::WrongType {
            key: key.to_owned(),
            wanted: wanted.to_owned(),
            found: type_name(value.get_ref()),
        };
        log.problem(value.span(), reason);
    };
    let Some(list) = value.get_ref().as_array() else {
        wrong(value, "a list of pairs, such as [[0.0, 1.0], [50.0, 2.0]]");
        return None;
    };
    let mut pairs = Vec::new();
    for item in list {
        let numbers = item.get_ref().as_array();
        let pair: Vec<f64> = numbers
            .into_iter()
            .flatten()
            .filter_map(|cell| number(cell.get_ref()))
            .collect();
        match (
            pair[..].try_into(),
            numbers.map(|cells| cells.iter().count()),
        ) {
            (Ok(pair), Some(2)) => pairs.push((pair, item.span())),
            _ => wrong(item, "made of pairs of numbers"),
        }
    }
    (pairs.len() == list.len()).then_some(pairs)
}

/// Scales, levels, smooths and joins points.
fn finish(
    channel: Channel,
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
    let mut report = |span: Range<usize>, reason: Reason| match &text {
        Some(text) => log.problem_in(text, span, reason),
        None => log.problem(span, reason),
    };
    match join(source, interpolation, knots) {
        Ok((waveform, placed)) => {
            let bad = out_of_range(channel, &placed);
            if let Some((index, reason)) = bad {
                report(spans.get(index).cloned().unwrap_or(0..0), reason);
                return None;
            }
            Some(waveform)
        }
        Err((error, placed)) => {
            let index = place_of(&error, &placed);
            let span = spans.get(index).cloned().unwrap_or(section.span());
            let section = section.path().to_owned();
            report(span, Reason::Waveform { section, error });
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
    let chosen = match source.interpolation {
        Some(InterpolationWord::HalfCosine) => Interpolation::HalfCosine,
        Some(InterpolationWord::Spline) => Interpolation::Spline,
        None => interpolation,
    };
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
fn out_of_range(channel: Channel, knots: &[Knot]) -> Option<(usize, Reason)> {
    let limits = channel.limits();
    let index = knots.iter().position(|knot| !limits.allow(knot.value))?;
    let unit = unit_of(channel.knots_key()).unwrap_or_default();
    let reason = Reason::OutOfRange {
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

/// The key that gives the points in the case file, for the table of keys.
pub(super) fn knots_doc(channel: Channel) -> (Key, &'static str) {
    let key = Key {
        name: channel.knots_key(),
        doc: "Points [percent of the cycle, value] in the case file itself.",
        kind: || "a list of pairs of numbers".to_owned(),
        default: Some(|| None),
        limits: Some(channel.limits()),
    };
    (key, split_unit(channel.knots_key()).1.unwrap_or_default())
}
