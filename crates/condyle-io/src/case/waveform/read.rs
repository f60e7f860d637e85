//! The waveform of a channel from its table.

use condyle::machine::Waveform;

use super::super::channel::CaseChannel;
use super::join::finish;
use super::keys::WaveformSource;
use super::points::points;
use crate::config::{Log, Section, Settings, names};

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
