//! Points made into a waveform, and what is checked on the way.

use condyle::machine::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};

use super::super::channel::CaseChannel;
use super::keys::{InterpolationWord, WaveformSource};
use super::points::Points;
use super::reason::WaveformReason;
use crate::config::{KeyReason, Log, Placed, Section, plain, unit_of};

/// Scales, levels, smooths and joins points.
pub(super) fn finish(
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
