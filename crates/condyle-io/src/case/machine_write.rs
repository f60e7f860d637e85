//! The simulator back as tables of a case.

use condyle::machine::Waveform;

use super::channel::CaseChannel;
use super::machine::{Freedom, Machine, Waveforms};
use super::machine_keys::Start;
use super::waveform::{DEFAULT_WAVEFORM, InterpolationWord};
use crate::config::{Settings, Writer, unit_of};

/// How the table of a waveform is written.
pub(super) type WriteWaveform = fn(&mut Writer, &str, CaseChannel, &Waveform);

impl Machine {
    /// Writes `[machine]` and the tables inside it.
    pub(super) fn write(&self, write_waveform: WriteWaveform, out: &mut Writer) {
        out.table("machine");
        let preset = self.preset;
        Start { preset }.write(out);
        self.settings.write(out);
        out.table("machine.springs");
        self.springs.write(out);
        self.waveforms.write("machine.", write_waveform, out);
        self.write_freedoms(out);
    }

    fn write_freedoms(&self, out: &mut Writer) {
        for (joint, freedom) in self.freedoms.in_files() {
            out.table(&format!("machine.freedoms.{}", joint.name));
            match freedom {
                Freedom::Translation(keys) => keys.write(out),
                Freedom::Rotation(keys) => keys.write(out),
            }
        }
    }
}

impl Waveforms {
    /// Writes a table a waveform, each with `above` before its name.
    pub(super) fn write(&self, above: &str, write_waveform: WriteWaveform, out: &mut Writer) {
        for channel in CaseChannel::all() {
            if let Some(waveform) = self.get(channel) {
                let table = format!("{above}{}", channel.name());
                write_waveform(out, &table, channel, waveform);
            }
        }
    }
}

/// The points of a waveform as its table.
pub(super) fn write_knots(
    out: &mut Writer,
    table: &str,
    channel: CaseChannel,
    waveform: &Waveform,
) {
    let interpolation = InterpolationWord::of(waveform.interpolation()).word();
    out.table(table);
    out.comment(channel.about());
    out.line(
        &format!("interpolation = {interpolation:?}"),
        "From point to point.",
    );
    let unit = unit_of(channel.knots_key()).unwrap_or_default();
    out.comment(&format!("[percent of the cycle, {unit}]"));
    let knots = waveform.knots().iter();
    let pairs: Vec<(f64, f64)> = knots.map(|knot| (knot.percent, knot.value)).collect();
    out.pairs(channel.knots_key(), &pairs);
}

/// The table of a waveform by its name.
pub(super) fn write_name(out: &mut Writer, table: &str, channel: CaseChannel, _: &Waveform) {
    out.table(table);
    out.comment(channel.about());
    out.line(
        &format!("waveform = {DEFAULT_WAVEFORM:?}"),
        "Or file and column, or knots.",
    );
}
