//! A joint of a mechanism as a description: what it is, not what drives it.

use super::{Channel, JointKind};

/// The line that a joint moves along or about, with a unit vector in the insert's directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Along a direction.
    Along([f64; 3]),
    /// About a direction, through a point of the insert frame that the machine sets for the joint
    /// ([`Joint::axis_point_mm`](super::Joint)).
    About([f64; 3]),
    /// About a direction, through the point of the femur that the femur turns about; the joints nearer to
    /// the insert carry it along.
    AboutFemur([f64; 3]),
}

/// Which body a joint moves. When the insert moves one way, the femur falls behind the other way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovedBody {
    /// The insert.
    Insert,
    /// The femur.
    Femur,
}

/// What a joint does while the machine settles under the load at the start of the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settling {
    /// It is free, and nothing pushes it, whatever drives it in the cycle.
    Free,
    /// It is held at zero.
    HeldAtZero,
    /// It is driven as at the start of the cycle, by its load too.
    Driven,
    /// It is driven as at the start of the cycle, but free of load where a load drives it.
    DrivenWithoutLoad,
}

/// Whether a joint can be free under a load, and which waveform gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loading {
    /// It cannot be free.
    None,
    /// It can be free, and nothing pushes it.
    Free,
    /// It can be free under a waveform.
    By(&'static Channel),
}

/// A joint of a mechanism: its names, its axis, how it settles, and the waveforms that can drive it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDescription {
    /// Its name in files: `ap`.
    pub name: &'static str,
    /// Its column in files of motions: the name and the unit.
    pub column: &'static str,
    /// What messages call it: `AP`.
    pub symbol: &'static str,
    /// What messages call it where there is room: `AnteroPosterior`.
    pub long_name: &'static str,
    /// What a page calls it.
    pub title: &'static str,
    /// Which way is positive, in words.
    pub positive: &'static str,
    /// Decimals that messages give of its position, in the unit of files.
    pub decimals: usize,
    /// Range below which a curve of it is drawn flat rather than enlarged, in the unit of files.
    pub least_span: f64,
    /// What it moves along or about.
    pub axis: Axis,
    /// What it moves, and so its sign.
    pub moves: MovedBody,
    /// What it does while the machine settles.
    pub settling: Settling,
    /// Whether it reads zero where the machine has settled.
    pub is_zeroed: bool,
    /// Mass in tonne, or moment of inertia in tonne mm2, unless a machine says otherwise.
    pub inertia: f64,
    /// Viscous damping, N s/mm or N mm s/rad, unless a machine says otherwise.
    pub damping: f64,
    /// The waveform that can prescribe its motion, if one can.
    pub motion: Option<&'static Channel>,
    /// The waveform that can load it.
    pub load: Loading,
}

impl JointDescription {
    /// Whether it turns or shifts.
    pub const fn kind(&self) -> JointKind {
        match self.axis {
            Axis::Along(_) => JointKind::Translation,
            Axis::About(_) | Axis::AboutFemur(_) => JointKind::Rotation,
        }
    }

    /// The waveform that can load it, if one can.
    pub const fn load_channel(&self) -> Option<&'static Channel> {
        match self.load {
            Loading::By(channel) => Some(channel),
            Loading::None | Loading::Free => None,
        }
    }

    /// Whether it can be free.
    pub const fn can_be_free(&self) -> bool {
        !matches!(self.load, Loading::None)
    }

    /// Whether it stands at zero once the machine has settled.
    pub fn settles_at_zero(&self) -> bool {
        self.is_zeroed || self.settling == Settling::HeldAtZero
    }
}
