//! The machine as six freedoms, each locked, prescribed or loaded.

use super::{ApSpring, Waveform};

/// A freedom of the machine, in the order of the chain from the insert to the femur.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Freedom {
    /// Varus-valgus of the insert, rad, + varus.
    VarusValgus,
    /// Internal-external rotation of the insert, rad, + internal.
    InternalExternal,
    /// Medio-lateral translation of the insert, mm, + lateral.
    MedioLateral,
    /// Antero-posterior translation of the insert, mm, + anterior.
    AnteroPosterior,
    /// Infero-superior translation of the femur, mm, + superior.
    InferoSuperior,
    /// Flexion of the femur, rad, + flexion.
    Flexion,
}

/// All six, in the order of the chain.
pub const FREEDOMS: [Freedom; 6] = [
    Freedom::VarusValgus,
    Freedom::InternalExternal,
    Freedom::MedioLateral,
    Freedom::AnteroPosterior,
    Freedom::InferoSuperior,
    Freedom::Flexion,
];

impl Freedom {
    /// Whether the freedom is a rotation, in rad and N mm, rather than a translation, in mm and N.
    pub fn is_rotation(self) -> bool {
        matches!(
            self,
            Self::VarusValgus | Self::InternalExternal | Self::Flexion
        )
    }
}

/// What moves a freedom.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// Held at a position, mm or rad.
    Locked(f64),
    /// Moved along a waveform of position, mm or rad.
    Prescribed(Waveform),
    /// Free under a waveform of load, N or N mm, with the sign of the motion it pushes.
    Loaded(Waveform),
}

/// One row of the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct FreedomSettings {
    /// What moves it.
    pub drive: Drive,
    /// Mass in tonne, or moment of inertia in tonne mm2.
    pub inertia: f64,
    /// Viscous damping, N s/mm or N mm s/rad.
    pub damping: f64,
}

/// A knee simulator: six freedoms, restraints, and where its axes lie.
///
/// The insert carries VV nearest to it, then IE, ML and AP towards the frame; the femur flexes on
/// a carriage that moves IS. All positions are in the insert frame with the machine at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// The six rows, in the order of [`FREEDOMS`].
    pub freedoms: [FreedomSettings; 6],
    /// Springs against AP motion and, by their offsets, IE rotation.
    pub ap_springs: Vec<ApSpring>,
    /// Gait cycles a second.
    pub frequency_hz: f64,
    /// Height and lateral place of the VV axis, which runs along x: (y, z), mm, in the insert frame.
    pub vv_axis_mm: (f64, f64),
    /// Place of the IE axis, which runs along y: (x, z), mm, in the insert frame.
    pub ie_axis_mm: (f64, f64),
}

impl Machine {
    /// The row of one freedom.
    pub fn row(&self, freedom: Freedom) -> &FreedomSettings {
        &self.freedoms[freedom as usize]
    }
}
