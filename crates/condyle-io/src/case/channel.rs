//! The waveforms a machine takes, and the named ones that come with condyle.

use condyle::machine::Interpolation;

use crate::keyed::{Limits, within};

/// A waveform of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Compression along IS, N.
    AxialForce,
    /// Flexion of the femur, degrees.
    Flexion,
    /// AP force on the insert, N, + anterior.
    ApForce,
    /// IE torque on the insert, N m, + internal.
    IeTorque,
    /// AP motion of the insert, mm, + anterior.
    ApMotion,
    /// IE rotation of the insert, degrees, + internal.
    IeMotion,
}

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
            text: include_str!(concat!("../../../../cases/waveforms/", $file)),
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

impl Channel {
    /// All of them, in the order they are written.
    pub const ALL: [Self; 6] = [
        Self::AxialForce,
        Self::Flexion,
        Self::ApForce,
        Self::IeTorque,
        Self::ApMotion,
        Self::IeMotion,
    ];

    /// Name of its table inside `[machine]`.
    pub fn name(self) -> &'static str {
        match self {
            Self::AxialForce => "axial_force",
            Self::Flexion => "flexion",
            Self::ApForce => "ap_force",
            Self::IeTorque => "ie_torque",
            Self::ApMotion => "ap_motion",
            Self::IeMotion => "ie_motion",
        }
    }

    /// What it is and which way is positive.
    pub fn about(self) -> &'static str {
        match self {
            Self::AxialForce => "Compression of the joint.",
            Self::Flexion => "Flexion of the femur, + flexion.",
            Self::ApForce => "AP force on the insert, + anterior.",
            Self::IeTorque => "Torque on the insert, + internal.",
            Self::ApMotion => "AP motion of the insert, + anterior.",
            Self::IeMotion => "IE rotation of the insert, + internal.",
        }
    }

    /// The key that gives its knots in the case file.
    pub fn knots_key(self) -> &'static str {
        match self {
            Self::AxialForce | Self::ApForce => "knots_n",
            Self::Flexion | Self::IeMotion => "knots_deg",
            Self::IeTorque => "knots_nm",
            Self::ApMotion => "knots_mm",
        }
    }

    /// What its values may be, in its unit.
    pub fn limits(self) -> Limits {
        match self {
            Self::AxialForce => within(0.0, 20_000.0),
            Self::Flexion => within(-45.0, 180.0),
            Self::ApForce => within(-5000.0, 5000.0),
            Self::IeTorque => within(-200.0, 200.0),
            Self::ApMotion => within(-50.0, 50.0),
            Self::IeMotion => within(-90.0, 90.0),
        }
    }

    /// The named waveforms it can have.
    pub(super) fn named(self) -> &'static [NamedWaveform] {
        const AXIAL_FORCE: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-axial-force.csv", HalfCosine),
            shipped!("paper-like", "paper-like-axial-force.csv", HalfCosine),
        ];
        const FLEXION: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-flexion.csv", HalfCosine),
            NONE,
        ];
        const AP_FORCE: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-ap-force.csv", HalfCosine),
            NONE,
        ];
        const IE_TORQUE: &[NamedWaveform] = &[
            shipped!("iso-like", "iso-like-ie-torque.csv", HalfCosine),
            NONE,
        ];
        const AP_MOTION: &[NamedWaveform] =
            &[shipped!("iso-like", "iso-like-ap-motion.csv", Spline), NONE];
        const IE_MOTION: &[NamedWaveform] =
            &[shipped!("iso-like", "iso-like-ie-motion.csv", Spline), NONE];
        match self {
            Self::AxialForce => AXIAL_FORCE,
            Self::Flexion => FLEXION,
            Self::ApForce => AP_FORCE,
            Self::IeTorque => IE_TORQUE,
            Self::ApMotion => AP_MOTION,
            Self::IeMotion => IE_MOTION,
        }
    }
}
