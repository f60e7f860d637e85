//! A waveform that a joint takes, as a description.

use super::JointKind;

/// The unit that the values of a waveform have in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelUnit {
    /// N.
    Newton,
    /// N m.
    NewtonMetre,
    /// mm.
    Millimetre,
    /// Degrees.
    Degree,
}

impl ChannelUnit {
    /// How a name ends that has the unit: `n` of `knots_n`.
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Newton => "n",
            Self::NewtonMetre => "nm",
            Self::Millimetre => JointKind::Translation.unit(),
            Self::Degree => JointKind::Rotation.unit(),
        }
    }

    /// How much of the solver's unit (N, N mm, mm, rad) it has.
    pub const fn in_solver(self) -> f64 {
        match self {
            Self::Newton => 1.0,
            Self::NewtonMetre => 1e3,
            Self::Millimetre => JointKind::Translation.file_unit_in_solver(),
            Self::Degree => JointKind::Rotation.file_unit_in_solver(),
        }
    }
}

/// A waveform that moves or loads a joint, as files have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Its name in files: `ap_force`.
    pub name: &'static str,
    /// What it is, and which way is positive.
    pub about: &'static str,
    /// The unit of its values.
    pub unit: ChannelUnit,
    /// 1 where its values have the sign of the joint, -1 where they have the other.
    pub sign: f64,
    /// Least that a value may be.
    pub least: f64,
    /// Most that a value may be.
    pub most: f64,
}

impl Channel {
    /// What a value in a file is multiplied by to act on the joint: sign and unit.
    pub const fn factor(&self) -> f64 {
        self.sign * self.unit.in_solver()
    }
}
