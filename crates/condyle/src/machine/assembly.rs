//! A machine: joints with their drives, springs, and its frequency.

use super::{Axis, JointDescription, JointIndex, JointKind, Ligament, Mechanism, Waveform};
use crate::{
    Vec3,
    spatial::{Mat6, Vec6},
};

/// Lever on which a moment counts as a force and a rotation as a motion, mm.
///
/// It is shorter than the distance of any of a machine's axes from the contact, about 20 to 30 mm, so that a moment
/// within the tolerance causes less force at the contact than the tolerance on forces.
const MOMENT_LEVER_MM: f64 = 10.0;

/// The lever of every joint, mm: it converts moments to forces and rotations to motions; 1 for a translation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levers(pub [f64; 6]);

impl Levers {
    /// Returns the largest force, N, of forces and moments; NaN if one is NaN, so that no residual with it counts as balanced.
    pub fn largest_n(&self, forces: &Vec6) -> f64 {
        let force = |j: usize| forces[j].abs() / self.0[j];
        let larger = |most: f64, force: f64| {
            if force > most || force.is_nan() {
                force
            } else {
                most
            }
        };
        (0..6).map(force).fold(0.0, larger)
    }

    /// Returns the root of the sum of the squares of forces and moments, N.
    pub fn length_n(&self, forces: &Vec6) -> f64 {
        let force = |j: usize| forces[j] / self.0[j];
        (0..6).map(|j| force(j).powi(2)).sum::<f64>().sqrt()
    }

    /// Returns the longest motion, mm, of translations and rotations.
    pub fn longest_mm(&self, motions: &Vec6) -> f64 {
        let motion = |j: usize| motions[j].abs() * self.0[j];
        (0..6).map(motion).fold(0.0, f64::max)
    }

    /// Returns the part of `motions`, at most 1, that moves no joint farther than `most_mm`.
    pub fn part_within(&self, motions: &Vec6, most_mm: f64) -> f64 {
        // Without motion the quotient is infinite, and the part 1.
        (most_mm / self.longest_mm(motions)).min(1.0)
    }
}

/// The drive of a joint.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// Held at a position, mm or rad.
    Locked(f64),
    /// Moved along a waveform of position, mm or rad.
    Prescribed(Waveform),
    /// Free under a waveform of load, N or N mm, positive in the direction of positive motion.
    Loaded(Waveform),
}

/// A joint of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its description.
    pub description: &'static JointDescription,
    /// Its drive.
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
    /// Creates a joint locked at zero, its axis through the origin, with the defaults of its description.
    fn new(description: &'static JointDescription) -> Self {
        Self {
            description,
            drive: Drive::Locked(0.0),
            inertia: description.inertia,
            damping: description.damping,
            axis_point_mm: Vec3::zeros(),
        }
    }

    /// Returns whether the joint is free under a load.
    pub fn is_loaded(&self) -> bool {
        matches!(self.drive, Drive::Loaded(_))
    }
}

/// A machine between insert and counterface: six joints, springs, ligaments, and the frequency of its cycles.
///
/// All positions are in the insert frame with the machine at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// The description of the joints.
    pub mechanism: &'static Mechanism,
    /// The joints, in the order of the chain.
    pub joints: [Joint; 6],
    /// The springs between the bodies.
    pub springs: Vec<Spring>,
    /// The ligaments between the bodies.
    pub ligaments: Vec<Ligament>,
    /// Cycles per second.
    pub frequency_hz: f64,
}

impl Machine {
    /// Creates a machine with every joint locked at zero, all axes through the origin and no springs, at one cycle a
    /// second.
    pub fn new(mechanism: &'static Mechanism) -> Self {
        Self {
            mechanism,
            joints: mechanism.joints.each_ref().map(Joint::new),
            springs: Vec::new(),
            ligaments: Vec::new(),
            frequency_hz: 1.0,
        }
    }

    /// Returns a joint.
    pub fn joint(&self, index: JointIndex) -> &Joint {
        &self.joints[index.place()]
    }

    /// Returns a joint for changes.
    pub fn joint_mut(&mut self, index: JointIndex) -> &mut Joint {
        &mut self.joints[index.place()]
    }

    /// Returns the loaded translation along y, whose load presses the bodies together, if there is one.
    pub fn pressing_joint(&self) -> Option<JointIndex> {
        let presses = |&index: &JointIndex| {
            let joint = self.joint(index);
            matches!(joint.description.axis, Axis::Along([0.0, _, 0.0])) && joint.is_loaded()
        };
        JointIndex::ALL.into_iter().find(presses)
    }

    pub(super) fn levers(&self) -> Levers {
        let lever = |joint: &Joint| match joint.description.kind() {
            JointKind::Rotation => MOMENT_LEVER_MM,
            JointKind::Translation => 1.0,
        };
        Levers(self.joints.each_ref().map(lever))
    }

    /// Places of the joints that are free under a load: their positions follow from the balance.
    pub(super) fn loaded(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&j| self.joints[j].is_loaded())
    }

    /// Places of the joints whose positions are given.
    pub(super) fn held(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&j| !self.joints[j].is_loaded())
    }

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

    /// Returns the load on every joint; 0 on those that are not loaded.
    pub(crate) fn loads_at(&self, phase: f64) -> Vec6 {
        Vec6::from_fn(|j, _| match &self.joints[j].drive {
            Drive::Loaded(waveform) => waveform.at(phase).0,
            Drive::Locked(_) | Drive::Prescribed(_) => 0.0,
        })
    }
}

/// A spring with free play along a joint; along a translation, it may be attached at an offset from the axis of a
/// rotation.
///
/// It is slack inside the free play around its rest position and linear beyond it, with one stiffness per direction.
/// The displacement of its attachment is u = q_along + L sin(q_about), L the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The joint along which it acts.
    pub along: JointIndex,
    /// The rotation from whose axis the offset is measured.
    pub about: JointIndex,
    /// Offset from that axis, mm: a positive rotation moves the attachment in the positive direction. A spring of one
    /// joint alone has none.
    pub offset_mm: f64,
    /// Stiffness against positive motion, N/mm, or N mm/rad along a rotation.
    pub positive_stiffness: f64,
    /// Stiffness against negative motion, in the same unit.
    pub negative_stiffness: f64,
    /// Motion in each direction before it engages, mm or rad.
    pub free_play: f64,
    /// Middle of the free play, mm or rad.
    pub rest: f64,
}

/// The force of a spring at given positions, and its derivatives.
struct Hold {
    force: f64,
    /// Derivative of the force by the displacement of the attachment.
    slope: f64,
    /// Derivative of that displacement by the rotation.
    by_turn: f64,
    /// Its second derivative.
    bend: f64,
}

impl Spring {
    /// Returns the load on the joint, N or N mm, and its derivative, for an attachment displaced by
    /// `moved`, mm or rad.
    pub fn force(&self, moved: f64) -> (f64, f64) {
        let moved = moved - self.rest;
        if moved > self.free_play {
            let k = self.positive_stiffness;
            (-k * (moved - self.free_play), -k)
        } else if moved < -self.free_play {
            let k = self.negative_stiffness;
            (-k * (moved + self.free_play), -k)
        } else {
            (0.0, 0.0)
        }
    }

    fn hold(&self, positions: &[f64; 6]) -> Hold {
        // The exact sine and not the angle: its derivatives below make the tangent exact for large rotations.
        let (sine, cosine) = self.about.of(positions).sin_cos();
        let (force, slope) = self.force(self.along.of(positions) + self.offset_mm * sine);
        Hold {
            force,
            slope,
            by_turn: self.offset_mm * cosine,
            bend: -self.offset_mm * sine,
        }
    }

    pub(super) fn subtract_force(&self, positions: &[f64; 6], residual: &mut Vec6) {
        let hold = self.hold(positions);
        residual[self.along.place()] -= hold.force;
        residual[self.about.place()] -= hold.force * hold.by_turn;
    }

    pub(super) fn subtract_stiffness(&self, positions: &[f64; 6], tangent: &mut Mat6) {
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
            positive_stiffness: 7.24,
            negative_stiffness: 33.8,
            free_play: 2.5,
            rest: 0.0,
        };
        assert_eq!(spring.force(2.5), (0.0, 0.0));
        assert_eq!(spring.force(-2.5), (0.0, 0.0));
        assert!((spring.force(3.5).0 + 7.24).abs() < 1e-12);
        assert!((spring.force(-4.5).0 - 67.6).abs() < 1e-12);
    }

    #[test]
    fn a_force_that_is_no_number_is_the_largest() {
        let mut forces = Vec6::zeros();
        forces[1] = f64::NAN;
        forces[4] = 3.0;
        assert!(Levers([1.0; 6]).largest_n(&forces).is_nan());
        forces[1] = -5.0;
        assert_eq!(Levers([1.0; 6]).largest_n(&forces), 5.0);
    }
}
