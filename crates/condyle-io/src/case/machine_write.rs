//! The simulator back as tables of a case.

use condyle::machine::Waveform;

use super::channel::CaseChannel;
use super::machine::{Freedom, Machine};
use super::machine_keys::Start;
use super::waveform::{DEFAULT_WAVEFORM, InterpolationWord};
use crate::keyed::{Settings, Writer, unit_of};

/// How the table of a waveform is written.
pub(super) type WriteWaveform = fn(&mut Writer, CaseChannel, &Waveform);

impl Machine {
    /// Writes `[machine]` and the tables inside it.
    pub(super) fn write(&self, write_waveform: WriteWaveform, out: &mut Writer) {
        out.table("machine");
        let preset = self.preset;
        Start { preset }.write(out);
        self.settings.write(out);
        out.table("machine.springs");
        self.springs.write(out);
        for channel in CaseChannel::all() {
            if let Some(waveform) = self.waveforms.get(channel) {
                write_waveform(out, channel, waveform);
            }
        }
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

/// The points of a waveform as its table.
pub(super) fn write_knots(out: &mut Writer, channel: CaseChannel, waveform: &Waveform) {
    let interpolation = InterpolationWord::of(waveform.interpolation()).word();
    out.table(&format!("machine.{}", channel.name()));
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
pub(super) fn write_name(out: &mut Writer, channel: CaseChannel, _: &Waveform) {
    out.table(&format!("machine.{}", channel.name()));
    out.comment(channel.about());
    out.line(
        &format!("waveform = {DEFAULT_WAVEFORM:?}"),
        "Or file and column, or knots.",
    );
}
