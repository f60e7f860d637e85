//! Springs that stand for the ligaments.

use super::{
    JointIndex,
    joint_vectors::{JointForces, JointStiffness},
};

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
