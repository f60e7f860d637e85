//! A ligament between the bodies: a straight line element that carries tension only.

use crate::{
    Vec3,
    spatial::{Mat6, Pose, Twist, Vec6},
};

/// The length at which a ligament goes slack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlackLength {
    /// This length, mm.
    Mm(f64),
    /// The length that gives this strain with the machine at zero, where the counterface has settled.
    StrainAtZero(f64),
}

/// A ligament with a toe region: without force up to its slack length, then quadratic, then linear.
///
/// With the strain e = L / L0 - 1, the stiffness k and the toe strain t, the tension is
/// 0 for e <= 0, k e^2 / (4 t) for 0 < e < 2 t, and k (e - t) beyond; its slope is continuous.
///
/// Source: Blankevoort 1991.
#[derive(Clone, Debug, PartialEq)]
pub struct Ligament {
    /// Its name in messages.
    pub name: String,
    /// Attachment to the bearing, in the insert frame, mm.
    pub on_bearing_mm: Vec3,
    /// Attachment to the counterface, in the counterface frame, mm.
    pub on_counterface_mm: Vec3,
    /// Tension per strain beyond the toe region, N.
    pub stiffness_n: f64,
    /// Half of the strain at the end of the toe region.
    pub toe_strain: f64,
    /// Its length without force.
    pub slack: SlackLength,
}

/// A ligament at a pose of the counterface, with the joints' screws there.
struct Stretched {
    tension_n: f64,
    /// Derivative of the tension by the length, N/mm.
    slope_n_per_mm: f64,
    length_mm: f64,
    /// From the bearing to the counterface.
    direction: Vec3,
    /// Motion of the attachment to the counterface per unit rate of each joint.
    by_joint: [Vec3; 6],
}

impl Ligament {
    /// Returns the tension, N, and its derivative by the strain, N.
    pub fn tension_n(&self, strain: f64) -> (f64, f64) {
        let (k, toe) = (self.stiffness_n, self.toe_strain);
        if strain <= 0.0 {
            (0.0, 0.0)
        } else if strain < 2.0 * toe {
            (k * strain * strain / (4.0 * toe), k * strain / (2.0 * toe))
        } else {
            (k * (strain - toe), k)
        }
    }

    /// Returns the length without force, mm, in a machine whose counterface frame is at `zero_mm` of the insert frame,
    /// parallel to it, with all joints at zero.
    fn slack_length_mm(&self, zero_mm: &Vec3) -> f64 {
        match self.slack {
            SlackLength::Mm(length_mm) => length_mm,
            SlackLength::StrainAtZero(strain) => {
                (zero_mm + self.on_counterface_mm - self.on_bearing_mm).norm() / (1.0 + strain)
            }
        }
    }

    /// Returns the strain at a pose of the counterface in a machine with its zero at `zero_mm`.
    pub fn strain(&self, zero_mm: &Vec3, pose: &Pose) -> f64 {
        let place = pose.to_insert(&self.on_counterface_mm);
        (place - self.on_bearing_mm).norm() / self.slack_length_mm(zero_mm) - 1.0
    }

    fn stretched(&self, zero_mm: &Vec3, pose: &Pose, screws: &[Twist; 6]) -> Option<Stretched> {
        let place = pose.to_insert(&self.on_counterface_mm);
        let line = place - self.on_bearing_mm;
        let (length_mm, slack_mm) = (line.norm(), self.slack_length_mm(zero_mm));
        let (tension_n, by_strain) = self.tension_n(length_mm / slack_mm - 1.0);
        // A slack ligament has no direction to speak of where its attachments meet.
        (tension_n > 0.0).then(|| Stretched {
            tension_n,
            slope_n_per_mm: by_strain / slack_mm,
            length_mm,
            direction: line / length_mm,
            by_joint: screws
                .each_ref()
                .map(|screw| screw.angular.cross(&place) + screw.linear),
        })
    }

    /// Subtracts the ligament's load on every joint: it pulls the counterface along -u with its tension T, which is
    /// -T u . d on a joint that moves the attachment by d.
    pub(super) fn subtract_force(
        &self,
        zero_mm: &Vec3,
        pose: &Pose,
        screws: &[Twist; 6],
        residual: &mut Vec6,
    ) {
        let Some(stretched) = self.stretched(zero_mm, pose, screws) else {
            return;
        };
        for (j, moved) in stretched.by_joint.iter().enumerate() {
            residual[j] += stretched.tension_n * stretched.direction.dot(moved);
        }
    }

    /// Subtracts the derivatives of those loads by the positions: the tension changes with the length, the line turns, and
    /// a joint turns the motions of the joints that it carries.
    pub(super) fn subtract_stiffness(
        &self,
        zero_mm: &Vec3,
        pose: &Pose,
        screws: &[Twist; 6],
        tangent: &mut Mat6,
    ) {
        let Some(stretched) = self.stretched(zero_mm, pose, screws) else {
            return;
        };
        let Stretched {
            tension_n,
            slope_n_per_mm,
            length_mm,
            direction,
            by_joint,
        } = stretched;
        for j in 0..6 {
            for k in 0..6 {
                let along = direction.dot(&by_joint[j]) * direction.dot(&by_joint[k]);
                let (first, last) = (j.min(k), j.max(k));
                let turned = screws[first].angular.cross(&by_joint[last]);
                tangent[(j, k)] += slope_n_per_mm * along
                    + tension_n
                        * ((by_joint[j].dot(&by_joint[k]) - along) / length_mm
                            + direction.dot(&turned));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{
        Chain, Machine,
        knee::{IE, KNEE, VV},
    };

    fn ligament(slack: SlackLength) -> Ligament {
        Ligament {
            name: "pcl".to_owned(),
            on_bearing_mm: Vec3::new(-20.0, -5.0, 2.0),
            on_counterface_mm: Vec3::new(4.0, -6.0, -3.0),
            stiffness_n: 9000.0,
            toe_strain: 0.03,
            slack,
        }
    }

    fn chain() -> Chain {
        let mut machine = Machine::new(&KNEE);
        machine.joint_mut(VV).axis_point_mm = Vec3::new(0.0, -20.0, -5.0);
        machine.joint_mut(IE).axis_point_mm = Vec3::new(1.0, 0.0, 0.5);
        Chain::new(&machine, Vec3::new(-5.0, 22.0, 0.0), (0.5, -0.3))
    }

    #[test]
    fn verify_tension_of_toe_and_line() {
        let ligament = ligament(SlackLength::Mm(30.0));
        assert_eq!(ligament.tension_n(-0.1), (0.0, 0.0));
        let (in_toe, slope) = ligament.tension_n(0.03);
        assert!((in_toe - 67.5).abs() < 1e-9 && (slope - 4500.0).abs() < 1e-9);
        let (at_end, slope) = ligament.tension_n(0.06);
        assert!((at_end - 270.0).abs() < 1e-9 && slope == 9000.0);
        let (just_before, _) = ligament.tension_n(0.06 - 1e-12);
        assert!((just_before - at_end).abs() < 1e-6);
        assert!((ligament.tension_n(0.1).0 - 630.0).abs() < 1e-9);
    }

    #[test]
    fn strain_at_zero_gives_the_slack_length() {
        let chain = chain();
        let ligament = ligament(SlackLength::StrainAtZero(0.02));
        let strain = ligament.strain(&chain.zero_mm(), &chain.at(&[0.0; 6]).pose);
        assert!((strain - 0.02).abs() < 1e-14);
    }

    /// The loads are the derivatives of the energy, the integral of the tension over the length, and the stiffness is that
    /// of the loads; central differences of five steps along every joint, in the toe region and beyond it.
    #[test]
    fn loads_and_stiffness_are_derivatives_of_the_energy() {
        let chain = chain();
        let zero_mm = chain.zero_mm();
        let somewhere = [0.03, -0.1, 1.2, -3.0, 0.4, 0.7];
        for strain in [0.04, 0.12] {
            let at = chain.at(&somewhere);
            let mut ligament = ligament(SlackLength::Mm(1.0));
            let length_mm = ligament.strain(&zero_mm, &at.pose) + 1.0;
            ligament.slack = SlackLength::Mm(length_mm / (1.0 + strain));
            let loads = |positions: &[f64; 6]| {
                let mut residual = Vec6::zeros();
                let at = chain.at(positions);
                ligament.subtract_force(&zero_mm, &at.pose, &at.screws, &mut residual);
                residual
            };
            let energy = |positions: &[f64; 6]| {
                let (k, toe) = (ligament.stiffness_n, ligament.toe_strain);
                let e = ligament.strain(&zero_mm, &chain.at(positions).pose);
                let of_strain = if e < 2.0 * toe {
                    k * e.powi(3) / (12.0 * toe)
                } else {
                    k * (e - toe).powi(2) / 2.0 + k * toe * toe / 6.0
                };
                of_strain * length_mm / (1.0 + strain)
            };
            let mut tangent = Mat6::zeros();
            ligament.subtract_stiffness(&zero_mm, &at.pose, &at.screws, &mut tangent);
            for joint in 0..6 {
                const STEP: f64 = 1e-5;
                let moved = |sign: f64| {
                    let mut positions = somewhere;
                    positions[joint] += sign * STEP;
                    positions
                };
                let (ahead, behind) = (moved(1.0), moved(-1.0));
                let slope = (energy(&ahead) - energy(&behind)) / (2.0 * STEP);
                let load = loads(&somewhere)[joint];
                assert!(
                    (slope - load).abs() < 1e-5 * load.abs().max(1.0),
                    "{slope} {load}"
                );
                let slopes = (loads(&ahead) - loads(&behind)) / (2.0 * STEP);
                let column = tangent.column(joint);
                assert!(
                    (slopes - column).norm() < 1e-6 * tangent.norm(),
                    "joint {joint}"
                );
            }
        }
    }
}
