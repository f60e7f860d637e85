//! A machine: its joints with what drives them, its springs, and how fast it goes.

use super::{JointDescription, JointIndex, Mechanism, Spring, Waveform, joint_vectors::Levers};
use crate::Vec3;

/// What moves a joint.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// Held at a position, mm or rad.
    Locked(f64),
    /// Moved along a waveform of position, mm or rad.
    Prescribed(Waveform),
    /// Free under a waveform of load, N or N mm, with the sign of the motion it pushes.
    Loaded(Waveform),
}

/// A joint of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// What it is.
    pub description: &'static JointDescription,
    /// What moves it.
    pub drive: Drive,
    /// Mass in tonne, or moment of inertia in tonne mm2.
    pub inertia: f64,
    /// Viscous damping, N s/mm or N mm s/rad.
    pub damping: f64,
    /// A point of its axis in the insert frame with the machine at zero, mm; only for an axis that
    /// [the machine sets](super::Axis::About).
    pub axis_point_mm: Vec3,
}

impl Joint {
    /// A joint locked at zero, its axis through the origin, else as it is described.
    fn new(description: &'static JointDescription) -> Self {
        Self {
            description,
            drive: Drive::Locked(0.0),
            inertia: description.inertia,
            damping: description.damping,
            axis_point_mm: Vec3::zeros(),
        }
    }

    /// Whether it is free under a load.
    pub fn is_loaded(&self) -> bool {
        matches!(self.drive, Drive::Loaded(_))
    }
}

/// A machine between insert and femur: six joints, springs, and how many cycles it does in a second.
///
/// All positions are in the insert frame with the machine at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// What its joints are.
    pub mechanism: &'static Mechanism,
    /// Its joints, in the order of the chain.
    pub joints: [Joint; 6],
    /// Springs beside its joints.
    pub springs: Vec<Spring>,
    /// Gait cycles a second.
    pub frequency_hz: f64,
}

impl Machine {
    /// A machine with every joint locked at zero, all axes through the origin and no springs, at one
    /// cycle a second.
    pub fn new(mechanism: &'static Mechanism) -> Self {
        Self {
            mechanism,
            joints: mechanism.joints.each_ref().map(Joint::new),
            springs: Vec::new(),
            frequency_hz: 1.0,
        }
    }

    /// One of its joints.
    pub fn joint(&self, index: JointIndex) -> &Joint {
        &self.joints[index.place()]
    }

    /// One of its joints, to be changed.
    pub fn joint_mut(&mut self, index: JointIndex) -> &mut Joint {
        &mut self.joints[index.place()]
    }

    /// The lever of every joint.
    pub(super) fn levers(&self) -> Levers {
        Levers::of(self.joints.each_ref().map(|joint| joint.description.kind()))
    }

    /// The places of the joints that are free under a load: their positions follow from the balance.
    pub(super) fn loaded(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&j| self.joints[j].is_loaded())
    }

    /// The places of the joints whose positions are given.
    pub(super) fn held(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&j| !self.joints[j].is_loaded())
    }
}
