//! The keys of a table that gives a waveform.

use condyle::machine::Interpolation;

use super::super::channel::CaseChannel;
use crate::config::{DataFile, Key, Kind, Settings, WhereSilent, choice, settings, within};

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
