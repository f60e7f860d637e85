//! A machine: joints with their drives, springs, and its frequency.

use super::{
    JointDescription, JointIndex, Mechanism, Waveform,
    joint_vectors::{JointForces, JointStiffness, Levers},
};
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

impl Machine {
    /// Sets positions and rates of the joints that are locked or prescribed.
    pub(super) fn drive(&self, phase: f64, positions: &mut [f64; 6], rates: &mut [f64; 6]) {
        for (j, joint) in self.joints.iter().enumerate() {
            match &joint.drive {
                Drive::Locked(at) => (positions[j], rates[j]) = (*at, 0.0),
                Drive::Prescribed(waveform) => {
                    let (value, slope) = waveform.at(phase);
                    (positions[j], rates[j]) = (value, slope * self.frequency_hz);
                }
                Drive::Loaded(_) => {}
            }
        }
    }

    /// Load on every joint; 0 on those that are not loaded.
    pub(super) fn loads_at(&self, phase: f64) -> JointForces {
        JointForces::from_fn(|j| match &self.joints[j].drive {
            Drive::Loaded(waveform) => waveform.at(phase).0,
            Drive::Locked(_) | Drive::Prescribed(_) => 0.0,
        })
    }
}

/// A spring with free play along a translation of the insert, fixed to it beside the axis of a rotation.
///
/// It is slack inside the free play and linear beyond it, with one stiffness against motion one way and
/// another against motion the other way. The point where it holds the insert has moved
///
/// u = q_along + L sin(q_about), L its offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The translation that it acts along.
    pub along: JointIndex,
    /// The rotation that it holds beside its axis.
    pub about: JointIndex,
    /// How far from that axis it holds, mm: a positive turn moves the point the positive way along.
    pub offset_mm: f64,
    /// Stiffness against positive motion, N/mm.
    pub positive_n_per_mm: f64,
    /// Stiffness against negative motion, N/mm.
    pub negative_n_per_mm: f64,
    /// Motion each way before it engages, mm.
    pub free_play_mm: f64,
}

/// How a spring holds a machine at given positions.
struct Hold {
    force: f64,
    /// Derivative of the force by the motion of the point.
    slope: f64,
    /// Derivative of that motion by the turn.
    by_turn: f64,
    /// Its second derivative.
    bend: f64,
}

impl Spring {
    /// Force on the insert (N, + along the joint) and its derivative (N/mm) when the point where the
    /// spring holds it has moved `moved_mm` from neutral.
    pub fn force(&self, moved_mm: f64) -> (f64, f64) {
        if moved_mm > self.free_play_mm {
            let k = self.positive_n_per_mm;
            (-k * (moved_mm - self.free_play_mm), -k)
        } else if moved_mm < -self.free_play_mm {
            let k = self.negative_n_per_mm;
            (-k * (moved_mm + self.free_play_mm), -k)
        } else {
            (0.0, 0.0)
        }
    }

    fn hold(&self, positions: &[f64; 6]) -> Hold {
        let (sine, cosine) = self.about.of(positions).sin_cos();
        let (force, slope) = self.force(self.along.of(positions) + self.offset_mm * sine);
        Hold {
            force,
            slope,
            by_turn: self.offset_mm * cosine,
            bend: -self.offset_mm * sine,
        }
    }

    /// Takes what the spring pushes from what is out of balance.
    pub(super) fn subtract_force(&self, positions: &[f64; 6], residual: &mut JointForces) {
        let hold = self.hold(positions);
        residual[self.along.place()] -= hold.force;
        residual[self.about.place()] -= hold.force * hold.by_turn;
    }

    /// Takes the derivatives of what the spring pushes from those of what is out of balance.
    pub(super) fn subtract_stiffness(&self, positions: &[f64; 6], tangent: &mut JointStiffness) {
        let hold = self.hold(positions);
        let (along, about) = (self.along.place(), self.about.place());
        tangent[(along, along)] -= hold.slope;
        tangent[(along, about)] -= hold.slope * hold.by_turn;
        tangent[(about, along)] -= hold.slope * hold.by_turn;
        tangent[(about, about)] -=
            hold.slope * hold.by_turn * hold.by_turn + hold.force * hold.bend;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::knee::{AP, IE};

    #[test]
    fn verify_free_play_then_linear() {
        let spring = Spring {
            along: AP,
            about: IE,
            offset_mm: 28.0,
            positive_n_per_mm: 7.24,
            negative_n_per_mm: 33.8,
            free_play_mm: 2.5,
        };
        assert_eq!(spring.force(2.5), (0.0, 0.0));
        assert_eq!(spring.force(-2.5), (0.0, 0.0));
        assert!((spring.force(3.5).0 + 7.24).abs() < 1e-12);
        assert!((spring.force(-4.5).0 - 67.6).abs() < 1e-12);
    }
}
