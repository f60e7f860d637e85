//! The balance of forces on every freedom, and its tangent.

use super::{
    ApSpring, Chain, Configuration, Drive, Freedom, Machine,
    joint_numbers::{Mat6, Vec6},
};
use crate::contact::{ContactModel, Response};
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

/// How rates and accelerations follow the positions within a step: 1/s and 1/s2.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepSlopes {
    pub rate: f64,
    pub acceleration: f64,
}

/// A machine and its contact at one instant.
pub(super) struct Balance<'a> {
    machine: &'a Machine,
    configuration: Configuration,
    kinematics: Kinematics,
    response: Response<'a>,
}

impl<'a> Balance<'a> {
    /// Lets the contact respond to the motion.
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
            kinematics,
            response,
        }
    }

    /// The residual r = M a + C v + springs - contact - load of every loaded freedom, N or N mm;
    /// 0 on the others.
    ///
    /// The contact does work on freedom j through its screw s_j, the motion of the femur past the
    /// insert: its load there is W . s_j, W the wrench on the femur.
    pub fn residual(&self, loads: &[f64; 6]) -> Vec6 {
        let on_femur = self.response.wrench.reaction();
        let mut residual = Vec6::zeros();
        for (j, row) in self.machine.freedoms.iter().enumerate() {
            residual[j] = row.inertia * self.kinematics.accelerations[j]
                + row.damping * self.kinematics.rates[j]
                - on_femur.power(&self.configuration.screws[j])
                - loads[j];
        }
        for spring in &self.machine.ap_springs {
            spring_forces(spring, &self.kinematics.positions, &mut residual);
        }
        for j in held(self.machine) {
            residual[j] = 0.0;
        }
        residual
    }

    /// How the contact answers.
    pub fn response(&self) -> &Response<'a> {
        &self.response
    }

    /// Derivative of the residual by the positions; the identity on rows that are not loaded.
    ///
    /// That of W . s_j by q_k has four parts: the wrench changes with the pose, with the twist
    /// that q_k's rate adds, with the turning of the other screws' twist, and s_j itself turns.
    pub fn tangent(&self, slopes: StepSlopes) -> Mat6 {
        let contact = self.response.tangent();
        let on_femur = self.response.wrench.reaction();
        let screws = &self.configuration.screws;
        let mut tangent = Mat6::zeros();
        for k in 0..6 {
            let mut twist_change = screws[k] * slopes.rate;
            for i in k + 1..6 {
                twist_change +=
                    self.configuration.screw_derivative(i, k) * self.kinematics.rates[i];
            }
            let by_pose = &contact.by_pose * &screws[k];
            let change = (by_pose + &contact.by_twist * &twist_change).reaction();
            for j in 0..6 {
                tangent[(j, k)] = -change.power(&screws[j])
                    - on_femur.power(&self.configuration.screw_derivative(j, k));
            }
        }
        for (j, row) in self.machine.freedoms.iter().enumerate() {
            tangent[(j, j)] += row.inertia * slopes.acceleration + row.damping * slopes.rate;
        }
        for spring in &self.machine.ap_springs {
            spring_stiffness(spring, &self.kinematics.positions, &mut tangent);
        }
        for j in held(self.machine) {
            tangent.row_mut(j).fill(0.0);
            tangent.column_mut(j).fill(0.0);
            tangent[(j, j)] = 1.0;
        }
        tangent
    }
}

/// Rows that are not loaded: their positions are given.
fn held(machine: &Machine) -> impl Iterator<Item = usize> + '_ {
    (0..6).filter(|&j| !matches!(machine.freedoms[j].drive, Drive::Loaded(_)))
}

/// Where a spring holds the insert: its point moves u = AP + L sin(IE) along the AP axis.
struct SpringPlace {
    force: f64,
    slope: f64,
    along: f64,
    across: f64,
}

const AP: usize = Freedom::AnteroPosterior as usize;
const IE: usize = Freedom::InternalExternal as usize;

fn spring_place(spring: &ApSpring, positions: &[f64; 6]) -> SpringPlace {
    let (sine, cosine) = positions[IE].sin_cos();
    let offset = spring.lateral_offset_mm;
    let (force, slope) = spring.force(positions[AP] + offset * sine);
    SpringPlace {
        force,
        slope,
        along: offset * cosine,
        across: -offset * sine,
    }
}

fn spring_forces(spring: &ApSpring, positions: &[f64; 6], residual: &mut Vec6) {
    let place = spring_place(spring, positions);
    residual[AP] -= place.force;
    residual[IE] -= place.force * place.along;
}

fn spring_stiffness(spring: &ApSpring, positions: &[f64; 6], tangent: &mut Mat6) {
    let SpringPlace {
        force,
        slope,
        along,
        across,
    } = spring_place(spring, positions);
    tangent[(AP, AP)] -= slope;
    tangent[(AP, IE)] -= slope * along;
    tangent[(IE, AP)] -= slope * along;
    tangent[(IE, IE)] -= slope * along * along + force * across;
}
