//! The balance of forces on every freedom, and its tangent.

use super::{ApSpring, Chain, Drive, FREEDOMS, Freedom, Machine};
use crate::contact::{ContactModel, Mat6, RelativeMotion, Vec6};
use serde::{Deserialize, Serialize};

/// Positions, rates and accelerations of the six freedoms, mm and rad and s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kinematics {
    /// Positions, mm or rad.
    pub positions: [f64; 6],
    /// Rates, mm/s or rad/s.
    pub rates: [f64; 6],
    /// Accelerations, mm/s2 or rad/s2.
    pub accelerations: [f64; 6],
}

/// What is out of balance, and how it changes with the positions.
pub(super) struct Imbalance {
    /// Inertia, damping, springs and contact against load, N or N mm; 0 on rows that are not loaded.
    pub residual: Vec6,
    /// Derivative of the residual by the positions; the identity on rows that are not loaded.
    pub tangent: Mat6,
}

/// How rates and accelerations follow the positions within a step: 1/s and 1/s2.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepSlopes {
    pub rate: f64,
    pub acceleration: f64,
}

/// The residual r = M a + C v + springs - contact - load of every loaded freedom.
///
/// A contact wrench W on the insert does work on freedom j through its screw s_j, the motion of
/// the femur relative to the insert, so the contact's force on that freedom is -W . s_j. Its
/// derivative by q_k has four parts: the wrench changes with the pose, with the twist that q_k's
/// rate adds, with the turning of the other screws' twist, and the screw s_j itself turns.
pub(super) fn imbalance(
    machine: &Machine,
    chain: &Chain,
    contact: &mut impl ContactModel,
    kinematics: &Kinematics,
    loads: &[f64; 6],
    slopes: StepSlopes,
) -> Imbalance {
    let configuration = chain.at(&kinematics.positions);
    let twist = configuration.twist(&kinematics.rates);
    let response = contact.respond(&RelativeMotion {
        pose: configuration.pose,
        twist,
    });
    let (mut residual, mut tangent) = (Vec6::zeros(), Mat6::zeros());
    for k in 0..6 {
        let twist_change: Vec6 = (k + 1..6)
            .map(|i| configuration.screw_derivative(i, k) * kinematics.rates[i])
            .sum::<Vec6>()
            + configuration.screws[k] * slopes.rate;
        let wrench_change =
            response.by_pose * configuration.screws[k] + response.by_twist * twist_change;
        for j in 0..6 {
            tangent[(j, k)] = configuration.screws[j].dot(&wrench_change)
                + configuration.screw_derivative(j, k).dot(&response.wrench);
        }
    }
    for (j, row) in machine.freedoms.iter().enumerate() {
        residual[j] = row.inertia * kinematics.accelerations[j]
            + row.damping * kinematics.rates[j]
            + configuration.screws[j].dot(&response.wrench)
            - loads[j];
        tangent[(j, j)] += row.inertia * slopes.acceleration + row.damping * slopes.rate;
    }
    for spring in &machine.ap_springs {
        add_spring(spring, &kinematics.positions, &mut residual, &mut tangent);
    }
    hold_rows(machine, &mut residual, &mut tangent);
    Imbalance { residual, tangent }
}

/// Adds a spring: its point moves u = AP + L sin(IE) along the AP axis.
fn add_spring(spring: &ApSpring, positions: &[f64; 6], residual: &mut Vec6, tangent: &mut Mat6) {
    let (ap, ie) = (
        Freedom::AnteroPosterior as usize,
        Freedom::InternalExternal as usize,
    );
    let (sine, cosine) = positions[ie].sin_cos();
    let (along, across) = (
        spring.lateral_offset_mm * cosine,
        -spring.lateral_offset_mm * sine,
    );
    let (force, slope) = spring.force(positions[ap] + spring.lateral_offset_mm * sine);
    residual[ap] -= force;
    residual[ie] -= force * along;
    tangent[(ap, ap)] -= slope;
    tangent[(ap, ie)] -= slope * along;
    tangent[(ie, ap)] -= slope * along;
    tangent[(ie, ie)] -= slope * along * along + force * across;
}

/// Takes the rows that are not loaded out of the system: their positions are given.
fn hold_rows(machine: &Machine, residual: &mut Vec6, tangent: &mut Mat6) {
    for freedom in FREEDOMS {
        if !matches!(machine.row(freedom).drive, Drive::Loaded(_)) {
            let j = freedom as usize;
            residual[j] = 0.0;
            tangent.row_mut(j).fill(0.0);
            tangent.column_mut(j).fill(0.0);
            tangent[(j, j)] = 1.0;
        }
    }
}
