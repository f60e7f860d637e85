//! The waveforms a machine takes, and the named ones that come with condyle.

use condyle::machine::{self, ChannelUnit, Interpolation, knee::KNEE};

use crate::config::{Limits, within};

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
