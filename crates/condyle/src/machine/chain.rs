//! The machine as a chain of six screw joints from the insert to the counterface.

use super::{Axis, Joint, Machine, MovedBody};
use crate::{
    Mat3, Vec3,
    spatial::{Pose, RelativeMotion, Twist},
};

/// Distance below which two places are the same but for round-off, mm.
const ROUNDING_MM: f64 = 1e-9;

/// The kinematics of the machine.
///
/// With the joints' screws e_j in the insert frame at zero, the counterface's pose in the insert is the
/// product of exponentials exp(e_1 q_1) ... exp(e_6 q_6) T_0 (Brockett 1984). Joints that move the insert
/// enter with a minus sign, since they move the insert and not the counterface.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    screws: [Twist; 6],
    /// Position of the counterface frame's origin in the insert frame with all joints at zero, mm.
    zero_mm: Vec3,
    flexion_axis_mm: (f64, f64),
}

/// The chain at given positions.
#[derive(Clone, Debug)]
pub struct Configuration {
    /// Pose of the counterface in the insert frame.
    pub pose: Pose,
    /// Motion of the counterface relative to the insert per unit rate of each joint.
    pub screws: [Twist; 6],
}

impl Chain {
    /// Creates the chain of a machine whose counterface, with all joints at zero, has its frame's origin at `zero_mm` in
    /// the insert frame and turns about the point (x, y, 0) of the counterface frame.
    pub fn new(machine: &Machine, zero_mm: Vec3, flexion_axis_mm: (f64, f64)) -> Self {
        let pivot_mm = zero_mm + Vec3::new(flexion_axis_mm.0, flexion_axis_mm.1, 0.0);
        Self {
            screws: machine
                .joints
                .each_ref()
                .map(|joint| screw(joint, pivot_mm)),
            zero_mm,
            flexion_axis_mm,
        }
    }

    /// Returns the chain with its zero moved to `positions` in the joints that settling zeroes, all of them translations, and
    /// the new readings there. The pose is the same.
    pub fn zeroed_at(&self, machine: &Machine, positions: &[f64; 6]) -> (Self, [f64; 6]) {
        let (mut zero_mm, mut readings) = (self.zero_mm, *positions);
        for (joint, reading) in machine.joints.iter().zip(&mut readings) {
            if joint.description.is_zeroed {
                // Translations commute with one another, and fixed axes stand before them in the chain: exact unless rotations of
                // the counterface do too.
                zero_mm += screw(joint, Vec3::zeros()).linear * *reading;
                *reading = 0.0;
            }
        }
        let zeroed = |zero_mm: Vec3| Self::new(machine, zero_mm, self.flexion_axis_mm);
        let place_mm = |chain: &Self| chain.at(&readings).pose.translation;
        let here = zeroed(zero_mm);
        let missing_mm = self.at(positions).pose.translation - place_mm(&here);
        // Rotations of the counterface before a translation turn it, and their centre moves with the zero: the place is a linear
        // function of the zero. Without such rotations nothing is missing but round-off.
        if missing_mm.norm() < ROUNDING_MM {
            return (here, readings);
        }
        let moved = |by: Vec3| place_mm(&zeroed(zero_mm + by)) - place_mm(&here);
        let moved = Mat3::from_columns(&[moved(Vec3::x()), moved(Vec3::y()), moved(Vec3::z())]);
        match moved.try_inverse() {
            Some(inverse) => (zeroed(zero_mm + inverse * missing_mm), readings),
            // No zero gives the pose: the joints keep their readings.
            None => (self.clone(), *positions),
        }
    }

    /// Returns the position of the counterface frame's origin in the insert frame with all joints at zero, mm.
    pub fn zero_mm(&self) -> Vec3 {
        self.zero_mm
    }

    /// Returns pose and screws at positions, mm and rad, in the order of the chain.
    pub fn at(&self, positions: &[f64; 6]) -> Configuration {
        let mut pose = Pose::identity();
        let mut screws = [Twist::zero(); 6];
        for ((screw, axis), &position) in screws.iter_mut().zip(&self.screws).zip(positions) {
            *screw = axis.carried(&pose);
            pose = pose.then(&axis.exponential(position));
        }
        // T_0 is a translation: the frames are parallel with all joints at zero.
        pose.translation += pose.rotation * self.zero_mm;
        Configuration { pose, screws }
    }
}

/// Returns the screw of a joint at zero, as the counterface's motion past the insert; the counterface rotates about `pivot_mm`.
fn screw(joint: &Joint, pivot_mm: Vec3) -> Twist {
    let directed = |direction: [f64; 3]| match joint.description.moves {
        MovedBody::Insert => -Vec3::from(direction),
        MovedBody::Counterface => Vec3::from(direction),
    };
    match joint.description.axis {
        Axis::Along(direction) => Twist::along(directed(direction)),
        Axis::About(direction) => Twist::about(directed(direction), joint.axis_point_mm),
        Axis::AboutCounterface(direction) => Twist::about(directed(direction), pivot_mm),
    }
}

impl Configuration {
    /// Returns pose and twist of the counterface relative to the insert at given rates.
    pub fn motion(&self, rates: &[f64; 6]) -> RelativeMotion {
        RelativeMotion {
            pose: self.pose,
            twist: self.twist(rates),
        }
    }

    /// Returns the twist of the counterface relative to the insert at given rates, in the insert frame.
    pub fn twist(&self, rates: &[f64; 6]) -> Twist {
        self.screws
            .iter()
            .zip(rates)
            .map(|(screw, &rate)| *screw * rate)
            .sum()
    }

    /// Returns the twist of the part that each joint carries, at given rates: the sum of s_i v_i over the joints
    /// farther from the insert.
    ///
    /// Joint k turns the screws that it carries by their Lie bracket with its own, and so their twist too.
    pub(super) fn carried_twists(&self, rates: &[f64; 6]) -> [Twist; 6] {
        let mut carried = [Twist::zero(); 6];
        // From the counterface inwards, so that every sum is built from the next one.
        for k in (0..5).rev() {
            carried[k] = carried[k + 1] + self.screws[k + 1] * rates[k + 1];
        }
        carried
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{
        JointIndex,
        knee::{AP, FLEXION, IE, IS, KNEE, ML, VV},
    };

    fn machine() -> Machine {
        let mut machine = Machine::new(&KNEE);
        machine.joint_mut(VV).axis_point_mm = Vec3::new(0.0, -20.0, -5.0);
        machine.joint_mut(IE).axis_point_mm = Vec3::new(1.0, 0.0, 0.5);
        machine
    }

    fn chain() -> Chain {
        Chain::new(&machine(), Vec3::new(-5.0, 22.0, 0.0), (0.5, -0.3))
    }

    const SOMEWHERE: [f64; 6] = [0.03, -0.1, 1.2, -3.0, 0.4, 0.7];

    #[test]
    fn verify_signs_of_every_joint() {
        let counterface_origin = |joint: JointIndex, position: f64| {
            let mut positions = [0.0; 6];
            positions[joint.place()] = position;
            chain().at(&positions).pose
        };
        let zero = Vec3::new(-5.0, 22.0, 0.0);
        // The insert moves anterior, lateral: the counterface falls behind, medial of it.
        assert!((counterface_origin(AP, 2.0).translation - zero + Vec3::x() * 2.0).norm() < 1e-12);
        assert!((counterface_origin(ML, 2.0).translation - zero + Vec3::z() * 2.0).norm() < 1e-12);
        assert!((counterface_origin(IS, 2.0).translation - zero - Vec3::y() * 2.0).norm() < 1e-12);
        // Flexion brings the back of the counterface down.
        assert!((counterface_origin(FLEXION, 0.5).rotation * -Vec3::x()).y < 0.0);
        // Internal rotation turns the insert's front medially: the counterface's front looks lateral.
        assert!((counterface_origin(IE, 0.5).rotation * Vec3::x()).z > 0.0);
        // Varus lowers the insert's lateral side: the counterface rises over it.
        assert!((counterface_origin(VV, 0.1).rotation * Vec3::z()).y > 0.0);
    }

    #[test]
    fn twist_is_the_derivative_of_the_pose() {
        let (step, rates) = (1e-6, [0.2, -0.4, 3.0, 5.0, -2.0, 1.1]);
        let at = |time: f64| {
            let mut positions = SOMEWHERE;
            positions
                .iter_mut()
                .zip(rates)
                .for_each(|(q, rate)| *q += rate * time);
            chain().at(&positions)
        };
        let Twist {
            angular, linear, ..
        } = at(0.0).twist(&rates);
        for point in [Vec3::new(1.0, -20.0, 23.0), Vec3::zeros()] {
            let place = |time| at(time).pose.to_insert(&point);
            let velocity = (place(step) - place(-step)) / (2.0 * step);
            assert!((velocity - linear - angular.cross(&place(0.0))).norm() < 1e-6);
        }
    }

    #[test]
    fn a_joint_turns_the_twist_that_it_carries() {
        let (step, rates) = (1e-6, [0.2, -0.4, 3.0, 5.0, -2.0, 1.1]);
        for by in 0..6 {
            let moved = |sign: f64| {
                let mut positions = SOMEWHERE;
                positions[by] += sign * step;
                chain().at(&positions).twist(&rates).numbers()
            };
            let difference = (moved(1.0) - moved(-1.0)) / (2.0 * step);
            let here = chain().at(&SOMEWHERE);
            let derivative = here.screws[by].bracket(&here.carried_twists(&rates)[by]);
            assert!((difference - derivative.numbers()).norm() < 1e-6);
        }
    }

    #[test]
    fn zeroing_keeps_the_pose_in_any_order_of_the_joints() {
        for order in [
            [VV, IE, ML, AP, IS, FLEXION],
            [FLEXION, ML, AP, IS, VV, IE],
            [FLEXION, VV, IE, IS, AP, ML],
            [VV, FLEXION, IE, ML, AP, IS],
        ] {
            let mut mechanism = KNEE.clone();
            let mut machine = machine();
            machine.joints = order.map(|index| machine.joint(index).clone());
            mechanism.joints = order.map(|index| *KNEE.joint(index));
            machine.mechanism = Box::leak(Box::new(mechanism));
            let positions = order.map(|index| SOMEWHERE[index.place()]);
            let chain = Chain::new(&machine, Vec3::new(-5.0, 22.0, 0.0), (0.5, -0.3));
            let (zeroed, readings) = chain.zeroed_at(&machine, &positions);
            for (joint, (reading, position)) in order.iter().zip(readings.iter().zip(positions)) {
                let is_zeroed = KNEE.joint(*joint).is_zeroed;
                assert_eq!(*reading, if is_zeroed { 0.0 } else { position });
            }
            let before = chain.at(&positions).pose;
            let after = zeroed.at(&readings).pose;
            assert!((before.translation - after.translation).norm() < 1e-12);
            assert!((before.rotation - after.rotation).norm() < 1e-12);
        }
    }
}
