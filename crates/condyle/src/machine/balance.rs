//! The balance of forces on every joint, and its tangent.
//!
//! Vectors have one number per joint in the order of the chain: forces in N and N mm, motions in mm and rad.

use super::{Chain, Configuration, Kinematics, Machine};
use crate::{
    Vec3,
    contact::{ContactModel, Response},
    spatial::{Mat6, RelativeMotion, Vec6},
};

/// Solves K dq = -f for the motions dq that remove `forces`; none if K is singular.
pub(super) fn correction(tangent: &Mat6, forces: &Vec6) -> Option<Vec6> {
    // LU and not Cholesky: friction makes the tangent unsymmetric.
    tangent.lu().solve(&-forces)
}

pub(super) fn move_by(positions: &mut [f64; 6], motions: &Vec6) {
    let moved = positions.iter_mut().zip(motions);
    moved.for_each(|(position, motion)| *position += motion);
}

/// A machine and its contact at one instant.
pub(super) struct Balance<'a> {
    machine: &'a Machine,
    configuration: Configuration,
    /// Position of the counterface frame in the insert frame with the machine at zero.
    zero_mm: Vec3,
    kinematics: Kinematics,
    contact: &'a dyn ContactModel,
    pub response: Response,
}

impl<'a> Balance<'a> {
    /// Evaluates the contact's response to the motion.
    pub fn new(
        machine: &'a Machine,
        chain: &Chain,
        contact: &'a mut dyn ContactModel,
        kinematics: Kinematics,
    ) -> Self {
        let configuration = chain.at(&kinematics.positions);
        let response = contact.respond(&configuration.motion(&kinematics.rates));
        Self {
            machine,
            configuration,
            zero_mm: chain.zero_mm(),
            kinematics,
            contact,
            response,
        }
    }

    /// Returns the residual r = M a + C v + springs + ligaments - contact - load of every loaded joint, N or N mm; 0 on the
    /// others.
    ///
    /// The contact does work on joint j through its screw s_j, the motion of the counterface past the
    /// insert: its load there is W . s_j, W the wrench on the counterface.
    pub fn residual(&self, loads: &Vec6) -> Vec6 {
        let on_counterface = self.response.wrench.reaction();
        let mut residual = Vec6::zeros();
        for (j, joint) in self.machine.joints.iter().enumerate() {
            residual[j] = joint.inertia * self.kinematics.accelerations[j]
                + joint.damping * self.kinematics.rates[j]
                - on_counterface.power(&self.configuration.screws[j])
                - loads[j];
        }
        for spring in &self.machine.springs {
            spring.subtract_force(&self.kinematics.positions, &mut residual);
        }
        let Configuration { pose, screws } = &self.configuration;
        for ligament in &self.machine.ligaments {
            ligament.subtract_force(&self.zero_mm, pose, screws, &mut residual);
        }
        for j in self.machine.held() {
            residual[j] = 0.0;
        }
        residual
    }

    /// Returns the counterface's motion past the insert at the balance's positions and other rates.
    pub fn motion_at(&self, rates: &[f64; 6]) -> RelativeMotion {
        self.configuration.motion(rates)
    }

    /// Returns the counterface's motion past the insert to which the contact has responded.
    pub fn motion(&self) -> RelativeMotion {
        self.motion_at(&self.kinematics.rates)
    }

    /// Returns the derivative of the residual by the positions, as exact as the contact's own; the identity on rows
    /// that are not loaded. `by_rate` and `by_acceleration` are the derivatives of rates and accelerations by the
    /// positions within a step, 1/s and 1/s2.
    pub fn tangent(&self, by_rate: f64, by_acceleration: f64) -> Mat6 {
        let mut tangent = self.contact_tangent(by_rate);
        for (j, joint) in self.machine.joints.iter().enumerate() {
            tangent[(j, j)] += joint.inertia * by_acceleration + joint.damping * by_rate;
        }
        for spring in &self.machine.springs {
            spring.subtract_stiffness(&self.kinematics.positions, &mut tangent);
        }
        let Configuration { pose, screws } = &self.configuration;
        for ligament in &self.machine.ligaments {
            ligament.subtract_stiffness(&self.zero_mm, pose, screws, &mut tangent);
        }
        // A held joint keeps its row and column out of the solution without changing the size of the system.
        for j in self.machine.held() {
            tangent.row_mut(j).fill(0.0);
            tangent.column_mut(j).fill(0.0);
            tangent[(j, j)] = 1.0;
        }
        tangent
    }

    /// Returns the derivative of the contact's part of the residual, -W . s_j, by the position of every joint k.
    fn contact_tangent(&self, by_rate: f64) -> Mat6 {
        let contact = self.contact.tangent();
        let on_counterface = self.response.wrench.reaction();
        let screws = &self.configuration.screws;
        let carried = self.configuration.carried_twists(&self.kinematics.rates);
        let mut tangent = Mat6::zeros();
        for k in 0..6 {
            // The twist is the sum of s_i v_i. Moving joint k changes its own rate v_k by the slope of
            // the step, and it turns every screw s_i that it carries, so that s_i v_i turns too.
            let twist_change = screws[k] * by_rate + screws[k].bracket(&carried[k]);
            // The wrench changes because the pose moves along s_k, and because the twist changes.
            let by_pose = &contact.by_pose * &screws[k];
            let change = (by_pose + &contact.by_twist * &twist_change).reaction();
            for j in 0..6 {
                tangent[(j, k)] = -change.power(&screws[j]);
            }
            // The product rule of W . s_j: the wrench changes, and s_j turns where k carries it.
            let on_carried = on_counterface.on_bracket_with(&screws[k]);
            for j in k + 1..6 {
                tangent[(j, k)] -= on_carried.power(&screws[j]);
            }
        }
        tangent
    }
}
