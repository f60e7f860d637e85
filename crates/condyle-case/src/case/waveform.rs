//! Waveforms of the machine: the named ones, their tables in a case, and their keys.

use condyle::machine::knee::KNEE;
use condyle::machine::{self, ChannelUnit, Interpolation, WaveformError};
use condyle::parameter::unit_of;
use thiserror::Error;

use crate::config::{
    DataFile, Key, Kind, Limits, Page, Reason, Settings, TableSchema, WhereSilent, choice,
    settings, within,
};

/// A waveform of the machine, as a case has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaseChannel(&'static machine::Channel);

/// A waveform with a name, as a CSV text.
pub(super) struct NamedWaveform {
    pub word: &'static str,
    pub file: &'static str,
    pub text: &'static str,
    pub interpolation: Interpolation,
}

macro_rules! shipped {
    ($word:literal, $file:literal, $interpolation:ident) => {
        NamedWaveform {
            word: $word,
            file: concat!("cases/waveforms/", $file),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/waveforms/", $file)),
            interpolation: Interpolation::$interpolation,
        }
    };
}

const NONE: NamedWaveform = NamedWaveform {
    word: "none",
    file: "none",
    text: "percent,none\n0,0\n",
    interpolation: Interpolation::HalfCosine,
};

impl CaseChannel {
    /// What presses the femur on the insert.
    pub(super) fn load() -> Self {
        Self(&machine::knee::AXIAL_FORCE)
    }

    /// All of them, in the order they are written.
    pub fn all() -> impl Iterator<Item = Self> {
        KNEE.channels.iter().copied().map(Self)
    }

    /// That of a machine's channel.
    pub fn of(channel: &'static machine::Channel) -> Self {
        Self(channel)
    }

    /// What the machine knows of it.
    pub fn of_machine(self) -> &'static machine::Channel {
        self.0
    }

    /// Name of its table inside `[machine]`.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// What it is and which way is positive.
    pub fn about(self) -> &'static str {
        self.0.about
    }

    /// The key that gives its knots in the case file.
    pub fn knots_key(self) -> &'static str {
        match self.0.unit {
            ChannelUnit::Newton => "knots_n",
            ChannelUnit::NewtonMetre => "knots_nm",
            ChannelUnit::Millimetre => "knots_mm",
            ChannelUnit::Degree => "knots_deg",
        }
    }

    /// What its values may be, in its unit.
    pub fn limits(self) -> Limits {
        within(self.0.least, self.0.most)
    }

    /// The words for the named waveforms it can have.
    pub(super) fn words(self) -> Vec<&'static str> {
        self.named().iter().map(|named| named.word).collect()
    }

    /// The named waveforms it can have.
    pub(super) fn named(self) -> &'static [NamedWaveform] {
        const AXIAL_FORCE: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-axial-force.csv", HalfCosine),
            shipped!("paper-like", "paper-like-axial-force.csv", HalfCosine),
            shipped!("stairs-like", "stairs-like-axial-force.csv", HalfCosine),
            shipped!("chair-like", "chair-like-axial-force.csv", HalfCosine),
        ];
        const FLEXION: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-flexion.csv", HalfCosine),
            shipped!("stairs-like", "stairs-like-flexion.csv", HalfCosine),
            shipped!("chair-like", "chair-like-flexion.csv", HalfCosine),
            NONE,
        ];
        const AP_FORCE: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-ap-force.csv", HalfCosine),
            shipped!("stairs-like", "stairs-like-ap-force.csv", HalfCosine),
            shipped!("chair-like", "chair-like-ap-force.csv", HalfCosine),
            NONE,
        ];
        const IE_TORQUE: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-ie-torque.csv", HalfCosine),
            shipped!("stairs-like", "stairs-like-ie-torque.csv", HalfCosine),
            shipped!("chair-like", "chair-like-ie-torque.csv", HalfCosine),
            NONE,
        ];
        const AP_MOTION: &[NamedWaveform] =
            &[shipped!("iso-like", "iso-like-ap-motion.csv", Spline), NONE];
        const IE_MOTION: &[NamedWaveform] =
            &[shipped!("iso-like", "iso-like-ie-motion.csv", Spline), NONE];
        match self.name() {
            "axial_force" => AXIAL_FORCE,
            "flexion" => FLEXION,
            "ap_force" => AP_FORCE,
            "ie_torque" => IE_TORQUE,
            "ap_motion" => AP_MOTION,
            "ie_motion" => IE_MOTION,
            _ => &[],
        }
    }
}

choice! {
    /// How a waveform goes from point to point.
    InterpolationWord {
        /// Half a cosine: flat at every point.
        HalfCosine = "half-cosine",
        /// The periodic cubic spline, for samples.
        Spline = "spline",
    }
}

impl InterpolationWord {
    /// The word for a way to go from point to point.
    pub fn of(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::HalfCosine => Self::HalfCosine,
            Interpolation::Spline => Self::Spline,
        }
    }

    /// The way itself.
    pub fn interpolation(self) -> Interpolation {
        match self {
            Self::HalfCosine => Interpolation::HalfCosine,
            Self::Spline => Interpolation::Spline,
        }
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
pub(crate) const DEFAULT_WAVEFORM: &str = "iso-like";

/// The keys that give the points of `channel`, of which a table has one: by name, from a file, or
/// in the case itself.
pub(crate) fn ways(channel: CaseChannel) -> [&'static str; 3] {
    ["waveform", "file", channel.knots_key()]
}

/// The keys of the table of `channel`.
pub(crate) fn waveform_keys(channel: CaseChannel) -> Vec<Key> {
    let named = |key: Key| match key.name {
        "waveform" => key.of_words(channel.words()),
        _ => key,
    };
    let source = WaveformSource::keys().into_iter().map(named);
    source.chain([knots_key(channel)]).collect()
}

/// The key that gives the points in the case file itself.
pub(crate) fn knots_key(channel: CaseChannel) -> Key {
    Key {
        name: channel.knots_key(),
        doc: "Points [percent of the cycle, value] in the case file itself.".into(),
        kind: Kind::Pairs,
        silent: WhereSilent::LeftOut,
        limits: Some(channel.limits()),
    }
}

/// Points that make no waveform.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("[{section}]: {error}")]
pub struct WaveformReason {
    /// The table of the waveform.
    pub section: String,
    /// Why.
    pub error: WaveformError,
}

impl Reason for WaveformReason {
    fn advice(&self) -> Option<String> {
        let may_drift = matches!(self.error, WaveformError::Seam { .. });
        may_drift.then(|| "or, for a measured cycle, set `remove_drift = true`".to_owned())
    }
}

const WAVEFORMS: &str = "\
One of `waveform`, `file` or the points themselves. A freedom takes the one its drive \
needs; one for another drive is an error.

";

const POINTS: &str = "
| table | points | unit | values may be | named | what |
| --- | --- | --- | --- | --- | --- |
";

/// Adds a table of keys for each waveform of the machine.
pub(super) fn with_waveforms(table: TableSchema) -> TableSchema {
    CaseChannel::all().fold(table, |table, channel| {
        let waveform = TableSchema::new(channel.about())
            .with_keys(&waveform_keys(channel))
            .with_one_of(&ways(channel))
            .with_need("column", "file");
        table.with_table(channel.name(), waveform)
    })
}

/// Adds the section of the book's page that lists the waveforms of the machine.
pub(super) fn list_waveforms(page: &mut Page) {
    let named = |channel: CaseChannel| format!("`[machine.{}]`", channel.name());
    let tables: Vec<String> = CaseChannel::all().map(named).collect();
    page.push(&format!("\n## Waveforms: {}\n\n", tables.join(", ")));
    page.push(WAVEFORMS);
    page.table(&WaveformSource::keys());
    page.push(POINTS);
    for channel in CaseChannel::all() {
        page.push(&waveform_row(channel));
    }
}

fn waveform_row(channel: CaseChannel) -> String {
    let key = knots_key(channel);
    format!(
        "| `{}` | `{}` | {} | {} | {} | {} |\n",
        channel.name(),
        key.name,
        unit_of(key.name).unwrap_or_default(),
        channel.limits(),
        channel.words().join(", "),
        channel.about(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_waveform_has_a_default_and_a_key_with_its_unit() {
        for channel in CaseChannel::all() {
            assert!(!channel.named().is_empty(), "{}", channel.name());
            let suffix = channel.of_machine().unit.suffix();
            assert_eq!(channel.knots_key(), format!("knots_{suffix}"));
        }
    }
}
