//! Waveforms of the machine: the shipped ones, their tables in a case, and their points there or in a CSV file.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use condyle::machine::knee::{self, KNEE};
use condyle::machine::{
    Channel, ChannelUnit, Interpolation, Knot, Waveform, WaveformError, extremes, low_passed,
    without_drift,
};
use condyle::parameter::unit_of;
use miette::NamedSource;

use crate::config::*;

/// A shipped waveform, as a CSV text.
struct NamedWaveform {
    /// Name of the channel with hyphens; empty for every channel.
    channel: &'static str,
    word: &'static str,
    /// Word and channel, by which the joints of a machine file name it.
    stem: &'static str,
    text: &'static str,
    interpolation: Interpolation,
}

macro_rules! shipped {
    ($( $channel:literal $interpolation:ident: $($word:literal)+; )+) => {
        &[$($(NamedWaveform {
            channel: $channel,
            word: $word,
            stem: concat!($word, "-", $channel),
            text: include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"), "/waveforms/", $word, "-", $channel, ".csv"
            )),
            interpolation: Interpolation::$interpolation,
        },)+)+]
    };
}

const SHIPPED: &[NamedWaveform] = shipped! {
    "axial-force" HalfCosine: "iso-like" "paper-like" "stairs-like" "chair-like";
    "flexion" HalfCosine: "iso-like" "stairs-like" "chair-like";
    "ap-force" HalfCosine: "iso-like" "stairs-like" "chair-like";
    "ie-torque" HalfCosine: "iso-like" "stairs-like" "chair-like";
    "ap-motion" Spline: "iso-like";
    "ie-motion" Spline: "iso-like";
};

const NONE: NamedWaveform = NamedWaveform {
    channel: "",
    word: "none",
    stem: "none",
    text: "percent,none\n0,0\n",
    interpolation: Interpolation::HalfCosine,
};

/// Returns the shipped waveforms of a channel, with the words for them; every channel except the load may also be zero. A joint
/// of a machine file takes every waveform of its unit.
fn named(
    channel: &'static Channel,
) -> impl Iterator<Item = (&'static str, &'static NamedWaveform)> {
    let shipped = SHIPPED.iter().filter_map(move |one| {
        let of_knee = KNEE.channel(&one.channel.replace('-', "_"))?;
        if of_knee == channel {
            Some((one.word, one))
        } else {
            let is_of_joint = KNEE.channel(channel.name).is_none();
            (is_of_joint && of_knee.unit == channel.unit).then_some((one.stem, one))
        }
    });
    shipped.chain((*channel != knee::AXIAL_FORCE).then_some((NONE.word, &NONE)))
}

pub(super) fn words_of(channel: &'static Channel) -> Vec<&'static str> {
    named(channel).map(|(word, _)| word).collect()
}

pub(super) fn knots_key(channel: &Channel) -> Key {
    let name = match channel.unit {
        ChannelUnit::Newton => "knots_n",
        ChannelUnit::NewtonMetre => "knots_nm",
        ChannelUnit::Millimetre => "knots_mm",
        ChannelUnit::Degree => "knots_deg",
    };
    let doc = "Points [percent of the cycle, value] in the case file itself.";
    let limits = Some(limits(channel));
    Key {
        limits,
        ..Key::optional(name, doc, Kind::Pairs)
    }
}

fn limits(channel: &Channel) -> Limits {
    within(channel.least, channel.most)
}

words! {
    Interpolation {
        HalfCosine = "half-cosine",
        Spline = "spline",
    }
}

settings! {
    /// Source of a waveform and its processing, in this order: scale, offset, drift, low pass.
    WaveformSource {
        /// Name of a waveform that comes with condyle.
        waveform: Option<String> = None;
        /// CSV file, relative to the case file; first column percent of the cycle.
        file: Option<DataFile> = None;
        /// Column of the file by its name in the header, which ends in its unit.
        column: Option<String> = None;
        /// Factor on every value.
        scale: f64 = 1.0, in within(-1e6, 1e6);
        /// Added to every scaled value, in the unit of the waveform.
        offset: f64 = 0.0, in within(-1e6, 1e6);
        /// Spreads the difference between 0 and 100 % over the cycle, for measured cycles.
        remove_drift: bool = false;
        /// Keeps the mean and this many harmonics, for noisy samples.
        low_pass_harmonics: Option<u64> = None, in within(1.0, 50.0);
        /// From point to point; half-cosine, but spline for a file, a low pass or more than 20 points.
        interpolation: Option<Interpolation> = None;
    }
}

/// Largest number of points in a case that are taken for the turning points of a curve, as in standards. More are samples: half-cosines
/// would stop at each of them, which raises cross-shear, and the wear of a knee by up to 70 %.
const MAX_TURNS: usize = 20;

/// The waveform of a knee simulator without activities whose case names none.
const DEFAULT_WAVEFORM: &str = "iso-like";

/// Describes the table of each waveform; with `has_default`, a table may leave the points to the default waveform.
pub(super) fn waveform_items(has_default: bool) -> Vec<Item> {
    let channels = KNEE.channels.iter();
    channels
        .map(|&channel| Item::Table(table(&[channel], has_default)))
        .collect()
}

/// Describes the table of a waveform that is one of `channels`, which share a name.
pub(super) fn table(channels: &[&'static Channel], has_default: bool) -> TableItem {
    let first = channels[0];
    let mut items = WaveformSource::items();
    for item in &mut items {
        if let Item::Key(key) = item
            && key.name == "waveform"
        {
            let mut known = BTreeSet::new();
            let words = channels.iter().flat_map(|channel| words_of(channel));
            // Every channel has the zero waveform.
            key.kind = Kind::Word(words.filter(|word| known.insert(*word)).collect());
        }
    }
    let knots: Vec<Key> = channels.iter().map(|channel| knots_key(channel)).collect();
    let mut ways = vec!["waveform", "file"];
    ways.extend(knots.iter().map(|key| key.name));
    items.extend(knots.into_iter().map(Item::Key));
    items.push(if has_default {
        Item::AtMostOne(ways)
    } else {
        Item::OneOf(ways)
    });
    items.push(Item::Needs("column", "file"));
    TableItem::new(first.name, first.about, items)
}

/// Points of a waveform before they are scaled.
struct Samples {
    knots: Vec<Knot>,
    /// Place of each point in `source`.
    spans: Vec<Range<usize>>,
    /// The text that the points are in; `None` for the case file.
    source: Option<Source>,
    interpolation: Interpolation,
}

/// Reads the waveform of `channel` from its table in `machine`.
pub(super) fn read(
    channel: &'static Channel,
    machine: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<Waveform> {
    let section = machine.table(channel.name, log);
    let keys = WaveformSource::read(&section, log)?;
    let samples = samples(channel, &section, &keys, log)?;
    if let Some(fault) = parts_of_a_cycle(samples.knots.iter().map(|knot| knot.percent)) {
        return samples.reject(samples.knots.len() - 1, fault, &section, log);
    }
    let knots = match levelled(samples.knots.clone(), &keys) {
        Ok(knots) => knots,
        Err((why, advice)) => {
            let message = format!("{} cannot lose its drift: {why}", section.name());
            let fault = Fault::new(message, advice);
            return log.reject(section.value_span("remove_drift"), fault);
        }
    };
    let interpolation = keys.interpolation.unwrap_or(samples.interpolation);
    let mut waveform = Waveform::new(knots.clone(), interpolation);
    if let (Ok(noisy), Some(harmonics)) = (&waveform, keys.low_pass_harmonics) {
        waveform = Waveform::new(low_passed(noisy, harmonics as usize), Interpolation::Spline);
    }
    let (index, fault) = match waveform {
        Ok(waveform) => match first_outside(channel, &knots) {
            Some(found) => found,
            None => match beyond_points(channel, &waveform) {
                Some(fault) => {
                    return log.reject(section.span(), fault);
                }
                None => return Some(cut_off(waveform, channel)),
            },
        },
        Err(error) => {
            let advice = match error {
                WaveformError::Seam { first, last, .. } if is_half_cycle(&knots, last - first) => {
                    HALF_CYCLE
                }
                WaveformError::Seam { to: 100.0, .. } => {
                    "or, for a measured cycle, set `remove_drift = true`"
                }
                WaveformError::Seam { .. } => {
                    "or set `remove_drift = true`; for a real step, `interpolation = \"half-cosine\"`"
                }
                _ => "",
            };
            let fault = Fault::new(format!("[{}]: {error}", section.path), advice);
            (point_of(&error, &knots), fault)
        }
    };
    samples.reject(index, fault, &section, log)
}

/// Largest drift that is removed, as a part of the range of the points; our choice: measured cycles of walking end within a tenth of
/// their range, and a movement that does not return has one of nearly all.
const MAX_DRIFT: f64 = 0.2;
const HALF_CYCLE: &str = "append the movement back to its start; for a real step, write `interpolation = \"half-cosine\"`";

fn is_half_cycle(knots: &[Knot], drift: f64) -> bool {
    let [low, high] = extremes(knots.iter().map(|knot| knot.value));
    drift.abs() > MAX_DRIFT * (high - low)
}

/// Returns points scaled, shifted and without drift.
///
/// # Errors
/// A drift that is unknown, or too large for that of a measured cycle: the reason and the advice.
fn levelled(
    mut knots: Vec<Knot>,
    keys: &WaveformSource,
) -> Result<Vec<Knot>, (String, &'static str)> {
    for knot in &mut knots {
        knot.value = knot.value * keys.scale + keys.offset;
    }
    // Drift is that of the scaled values, so that the seam closes in the unit of the machine.
    if !keys.remove_drift {
        return Ok(knots);
    }
    let Some(level) = without_drift(&knots) else {
        let advice = "give points up to 100 %, or to the last sample before it";
        return Err(("its points end before the cycle".to_owned(), advice));
    };
    // Half of the drift is added to the first point.
    let drift = 2.0 * (level[0].value - knots[0].value);
    if is_half_cycle(&knots, drift) {
        let why = format!(
            "its end is {:.3} from its start, more than {:.0} % of its range",
            drift.abs(),
            100.0 * MAX_DRIFT
        );
        return Err((why, HALF_CYCLE));
    }
    Ok(level)
}

/// Writes the table of a waveform, by the default name or by its points.
pub(super) fn write(channel: &'static Channel, waveform: &Waveform, out: &mut Writer) {
    out.comment(channel.about);
    if out.names_waveforms && words_of(channel).contains(&DEFAULT_WAVEFORM) {
        let name = format!("waveform = {DEFAULT_WAVEFORM:?}");
        out.line(&name, "Or file and column, or knots.");
        return;
    }
    let interpolation = waveform.interpolation().text().unwrap_or_default();
    out.line(
        &format!("interpolation = {interpolation}"),
        "From point to point.",
    );
    let key = knots_key(channel).name;
    out.comment(&format!(
        "[percent of the cycle, {}], after scale, offset and low pass",
        unit_of(key).unwrap_or_default()
    ));
    let knots = waveform.knots().iter();
    let pairs: Vec<(f64, f64)> = knots.map(|knot| (knot.percent, knot.value)).collect();
    out.pairs(key, &pairs);
}

/// Reads the points that the table gives by name, by file or directly.
fn samples(
    channel: &'static Channel,
    section: &Section<'_>,
    keys: &WaveformSource,
    log: &mut Log<'_>,
) -> Option<Samples> {
    let knots = knots_key(channel);
    let ways = ["waveform", "file", knots.name];
    let mut given = ways.into_iter().filter(|way| section.value(way).is_some());
    if let (Some(first), Some(second)) = (given.next(), given.next()) {
        let fault = both(&section.name(), first, second);
        return log.reject(section.key_span(second), fault);
    }
    if keys.column.is_some() && keys.file.is_none() {
        log.problem(section.key_span("column"), idle("column", "`file`"));
    }
    if let Some(file) = &keys.file {
        return from_file(channel, section, file, keys.column.as_deref(), log);
    }
    let points: Option<Points> = section.setting(&knots, Some(None), log)?;
    if let Some(Points(points)) = points {
        let place = |index| section.item_span(knots.name, index);
        let knot = |&(percent, value): &(f64, f64)| Knot { percent, value };
        let interpolation = match points.len() > MAX_TURNS {
            true => Interpolation::Spline,
            false => Interpolation::HalfCosine,
        };
        return Some(Samples {
            knots: points.iter().map(knot).collect(),
            spans: (0..points.len()).map(place).collect(),
            source: None,
            interpolation,
        });
    }
    // Activities do not inherit waveforms, and machine files have none.
    let has_default =
        KNEE.channel(channel.name).is_some() && !section.path.starts_with("activity.");
    if !has_default && keys.waveform.is_none() {
        let message = format!("{} needs one of `{}`", section.name(), ways.join("`, `"));
        return log.reject(section.span(), Fault::new(message, ""));
    }
    let word = keys.waveform.as_deref().unwrap_or(DEFAULT_WAVEFORM);
    let Some((_, named)) = named(channel).find(|(own, _)| *own == word) else {
        let fault = unknown_word("waveform", word, &words_of(channel));
        return log.reject(section.value_span("waveform"), fault);
    };
    let file = format!("cases/waveforms/{}.csv", named.stem);
    let columns = Columns::split(named.text, &file, "");
    let read = columns.and_then(|columns| column_points(&columns, 1));
    let source = Arc::new(NamedSource::new(file, named.text.to_owned()));
    Samples::in_text(source, read, named.interpolation, log)
}

fn from_file(
    channel: &Channel,
    section: &Section<'_>,
    file: &DataFile,
    column: Option<&str>,
    log: &mut Log<'_>,
) -> Option<Samples> {
    let source = file.source(section, "file", log)?;
    let key = knots_key(channel).name;
    let suffix = key.trim_start_matches("knots");
    let example = format!("percent,{}{suffix}", channel.name);
    let split = Columns::split(source.inner(), &file.name(), &example);
    let columns = log.noted(&source, split)?;
    let names = columns.names();
    let index = match column {
        Some(column) => (1..names.len()).find(|&index| names[index] == column),
        None => (names.len() == 2).then_some(1),
    };
    let Some(index) = index else {
        let (columns, file) = (&names[1..], file.name());
        let (key, fault) = match column {
            Some(column) => ("column", no_column(column, &file, columns)),
            None => {
                let message = format!("{file} has several columns and the case names none of them");
                let advice = format!("add `column = `, one of {}", columns.join(", "));
                ("file", Fault::new(message, advice))
            }
        };
        return log.reject(section.value_span(key), fault);
    };
    let mut problems = Vec::new();
    // The whole name, as in "Gait cycle (%)".
    let first = source.inner()[columns.name_span(0)].to_lowercase();
    let mut words = ["percent", "pct", "%"].iter();
    if !words.any(|word| first.contains(word)) {
        let name = names[0];
        let message =
            format!("the first column must be the percent of the cycle, this one is `{name}`");
        let fault = Fault::new(message, "name it `percent`, and let it run from 0 to 100");
        problems.push((columns.name_span(0), fault));
    }
    if names[index + 1..].contains(&names[index]) {
        problems.push((columns.name_span(index), repeated_column(names[index])));
    }
    let unit = unit_of(key);
    if columns.unit(index) != unit {
        let fault = other_unit(names[index], unit.unwrap_or_default(), suffix);
        problems.push((columns.name_span(index), fault));
    }
    let read = if problems.is_empty() {
        column_points(&columns, index)
    } else {
        Err(problems)
    };
    Samples::in_text(Arc::clone(&source), read, Interpolation::Spline, log)
}

type PlacedKnots = (Vec<Knot>, Vec<Range<usize>>);

impl Samples {
    fn in_text(
        source: Source,
        read: Result<PlacedKnots, Vec<Placed>>,
        interpolation: Interpolation,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let (knots, spans) = log.noted(&source, read)?;
        let source = Some(source);
        Some(Self {
            knots,
            spans,
            source,
            interpolation,
        })
    }

    /// Reports a fault of a point; one of the whole waveform has no point and is shown at its table.
    fn reject<T>(
        &self,
        index: usize,
        fault: Fault,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) -> Option<T> {
        let span = self.spans.get(index).cloned().unwrap_or(section.span());
        match &self.source {
            Some(source) => log.noted(source, Err(vec![(span, fault)])),
            None => log.reject(span, fault),
        }
    }
}

/// Returns the fault of points whose cycle runs from 0 to 1.
pub(crate) fn parts_of_a_cycle(percents: impl ExactSizeIterator<Item = f64>) -> Option<Fault> {
    let is_enough = percents.len() > 2;
    let last = percents
        .reduce(f64::max)
        .filter(|last| is_enough && *last <= 1.0)?;
    let advice = "give percent from 0 to 100, not parts of the cycle from 0 to 1";
    Some(Fault::new(
        format!("the points end at {last} % of the cycle"),
        advice,
    ))
}

/// Reads percent from the first column and values from column `index`.
fn column_points(columns: &Columns<'_>, index: usize) -> Result<PlacedKnots, Vec<Placed>> {
    let (percents, values) = match (columns.numbers(0), columns.numbers(index)) {
        (Ok(percents), Ok(values)) => (percents, values),
        (percents, values) => {
            let problems = [percents.err(), values.err()].into_iter().flatten();
            return Err(problems.flatten().collect());
        }
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

/// Part of the largest value by which others may be outside the range: a load cell reads a few newtons below zero without a load,
/// and so does a low pass.
const ROUGHLY: f64 = 0.01;

fn first_outside(channel: &Channel, knots: &[Knot]) -> Option<(usize, Fault)> {
    let limits = limits(channel);
    let sizes = knots.iter().map(|knot| knot.value.abs());
    let rough = ROUGHLY * sizes.fold(0.0, f64::max).min(channel.most);
    let allowed = within(channel.least - rough, channel.most + rough);
    let index = knots.iter().position(|knot| !allowed.allow(knot.value))?;
    let (knot, unit) = (
        &knots[index],
        unit_of(knots_key(channel).name).unwrap_or_default(),
    );
    let value = format!("{} {unit} at {} %", plain(knot.value), knot.percent);
    let fault = out_of_range(channel.name, &value, &format!("{limits} {unit}"));
    Some((index, fault))
}

/// Cuts a waveform that is roughly in its range off at the limits: a load that lifts a body by a few newtons would move it far.
fn cut_off(waveform: Waveform, channel: &Channel) -> Waveform {
    let ([low, high], limits) = (waveform.range(), [channel.least, channel.most]);
    match low < channel.least || high > channel.most {
        true => waveform.limited(limits),
        false => waveform,
    }
}

/// Cuts a load that presses the bodies together off at zero if it is roughly on one side of it, as [`cut_off`].
pub(crate) fn cut_off_at_zero(waveform: Waveform) -> Waveform {
    let [low, high] = waveform.range();
    let rough = ROUGHLY * high.max(-low);
    match (low < 0.0 && low >= -rough, high > 0.0 && high <= rough) {
        (true, _) => waveform.limited([0.0, f64::INFINITY]),
        (_, true) => waveform.limited([f64::NEG_INFINITY, 0.0]),
        _ => waveform,
    }
}

/// Returns the fault of values outside the range between the points, which a spline or a low pass makes.
fn beyond_points(channel: &Channel, waveform: &Waveform) -> Option<Fault> {
    let percents = (0..1000).map(|place| f64::from(place) / 10.0);
    let values: Vec<Knot> = percents
        .map(|percent| Knot {
            percent,
            value: waveform.at(percent / 100.0).0,
        })
        .collect();
    let (_, fault) = first_outside(channel, &values)?;
    let advice = "the spline between the points, or the low pass, leaves the range: give more points, keep more harmonics, or write \
                  `interpolation = \"half-cosine\"`";
    Some(Fault::new(fault.message, advice))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_waveform_has_a_default_and_a_key_with_its_unit() {
        for channel in KNEE.channels {
            assert!(
                words_of(channel).contains(&DEFAULT_WAVEFORM),
                "{}",
                channel.name
            );
            let suffix = channel.unit.suffix();
            assert_eq!(knots_key(channel).name, format!("knots_{suffix}"));
        }
    }
}
