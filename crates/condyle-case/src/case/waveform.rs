//! Waveforms of the machine: the named ones, their tables in a case, and their keys.

use condyle::machine::knee::KNEE;
use condyle::machine::{self, ChannelUnit, Interpolation};
use condyle::parameter::unit_of;

use crate::config::{
    DataFile, Item, Key, Kind, Limits, Settings, TableItem, WhereSilent, choice, keys, rows,
    settings, within,
};

/// A waveform of the machine, as a case has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaseChannel(&'static machine::Channel);

/// A shipped waveform, as a CSV text.
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
    /// Returns the channel of the load that presses the femur on the insert.
    pub(super) fn load() -> Self {
        Self(&machine::knee::AXIAL_FORCE)
    }

    /// Returns every channel, in the order they are written.
    pub fn all() -> impl Iterator<Item = Self> {
        KNEE.channels.iter().copied().map(Self)
    }

    /// Returns the channel of a machine.
    pub fn of(channel: &'static machine::Channel) -> Self {
        Self(channel)
    }

    /// Returns the machine's description.
    pub fn of_machine(self) -> &'static machine::Channel {
        self.0
    }

    /// Name of its table inside `[machine]`.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Describes it and its positive direction.
    pub fn about(self) -> &'static str {
        self.0.about
    }

    /// Returns the key that gives its knots in the case file.
    pub fn knots_key(self) -> &'static str {
        match self.0.unit {
            ChannelUnit::Newton => "knots_n",
            ChannelUnit::NewtonMetre => "knots_nm",
            ChannelUnit::Millimetre => "knots_mm",
            ChannelUnit::Degree => "knots_deg",
        }
    }

    pub(super) fn knots(self) -> Key {
        Key {
            name: self.knots_key(),
            doc: "Points [percent of the cycle, value] in the case file itself.".into(),
            kind: Kind::Pairs,
            silent: WhereSilent::LeftOut,
            limits: Some(self.limits()),
        }
    }

    /// Returns the keys of which exactly one gives the points: by name, from a file, or directly.
    pub(super) fn ways(self) -> [&'static str; 3] {
        ["waveform", "file", self.knots_key()]
    }

    fn items(self) -> Vec<Item> {
        let mut items = WaveformSource::items();
        for item in &mut items {
            if let Item::Key(key) = item
                && key.name == "waveform"
            {
                key.kind = Kind::Word(self.words());
            }
        }
        items.extend([
            Item::Key(self.knots()),
            Item::OneOf(self.ways().to_vec()),
            Item::Needs("column", "file"),
        ]);
        items
    }

    /// Returns the range of its values, in its unit.
    pub fn limits(self) -> Limits {
        within(self.0.least, self.0.most)
    }

    pub(super) fn words(self) -> Vec<&'static str> {
        self.named().iter().map(|named| named.word).collect()
    }

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
    /// Interpolation between the points of a waveform.
    InterpolationWord {
        /// Half a cosine: flat at every point.
        HalfCosine = "half-cosine",
        /// The periodic cubic spline, for samples.
        Spline = "spline",
    }
}

impl InterpolationWord {
    /// Returns the word for an interpolation.
    pub fn of(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::HalfCosine => Self::HalfCosine,
            Interpolation::Spline => Self::Spline,
        }
    }

    /// Returns the interpolation.
    pub fn interpolation(self) -> Interpolation {
        match self {
            Self::HalfCosine => Interpolation::HalfCosine,
            Self::Spline => Interpolation::Spline,
        }
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
        /// From point to point; half-cosine, but spline for a file or a low pass.
        interpolation: Option<InterpolationWord> = None;
    }
}

/// The waveform of a case that gives none.
pub(super) const DEFAULT_WAVEFORM: &str = "iso-like";

const WAVEFORMS: &str = "\
One of `waveform`, `file` or the points themselves. A freedom takes the waveform that its drive \
needs; one for another drive is an error.

";

const POINTS: &str = "
| table | points | unit | values may be | named | what |
| --- | --- | --- | --- | --- | --- |
";

/// Describes the table of each waveform; with `in_book`, the first also describes all of them in the book.
pub(super) fn waveform_items(in_book: bool) -> Vec<Item> {
    let items = CaseChannel::all().enumerate().map(|(index, channel)| {
        let page = if in_book && index == 0 {
            page()
        } else {
            String::new()
        };
        Item::Table(TableItem {
            page: Some(page),
            ..TableItem::new(channel.name(), channel.about(), channel.items())
        })
    });
    items.collect()
}

fn page() -> String {
    let named = |channel: CaseChannel| format!("`[machine.{}]`", channel.name());
    let tables: Vec<String> = CaseChannel::all().map(named).collect();
    let keys = rows(&keys(&WaveformSource::items()));
    let channels: String = CaseChannel::all().map(row).collect();
    format!(
        "\n## Waveforms: {}\n\n{WAVEFORMS}{keys}{POINTS}{channels}",
        tables.join(", ")
    )
}

fn row(channel: CaseChannel) -> String {
    let key = channel.knots_key();
    format!(
        "| `{}` | `{key}` | {} | {} | {} | {} |\n",
        channel.name(),
        unit_of(key).unwrap_or_default(),
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
