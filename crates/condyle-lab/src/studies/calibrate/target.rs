//! What a deformable insert does in an increment, and where a foundation does the same.

use condyle::{
    Vec3,
    contact::{ContactModel, ContactResult, MAX_REGIONS},
    evolve::SolvedCycle,
    spatial::{Pose, RelativeMotion},
};
use nalgebra::Rotation3;

/// Forces on the sides are met to this, N.
const FORCE_TOLERANCE_N: f64 = 0.05;
/// A side that carries less is as if it carried nothing, N.
const MIN_FORCE_N: f64 = 1.0;
/// Most iterations until they are.
const ITERATIONS: usize = 30;
/// By how much the femur is lowered to see how stiff the sides are, mm.
const PROBE_MM: f64 = 1e-4;
/// How far the femur moves at most in an iteration, mm.
const FARTHEST_MM: f64 = 0.03;

/// What a deformable insert does in an increment.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub percent: f64,
    pub pose: Pose,
    /// Part of the axial force on every region of the surface, N.
    pub region_force_n: [f64; MAX_REGIONS],
    pub area_mm2: f64,
    pub peak_mpa: f64,
    /// Where the force of every region acts, z, mm.
    pub arms_mm: [f64; MAX_REGIONS],
}

/// How a foundation carries the same forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carried {
    pub area_mm2: f64,
    pub peak_mpa: f64,
    /// By how much the femur is lower over every region than on the deformable insert, mm.
    pub lower_mm: [f64; MAX_REGIONS],
}

impl Target {
    /// Those of a cycle solved on a deformable insert.
    pub fn of(cycle: &SolvedCycle<'_>) -> Vec<Self> {
        let of_one = |(increment, row): (usize, &condyle::machine::CycleRow)| Self {
            percent: row.percent,
            pose: cycle.pose(increment),
            region_force_n: row.region_force_n,
            area_mm2: row.contact_area_mm2,
            peak_mpa: row.peak_pressure_mpa,
            arms_mm: [0.0; MAX_REGIONS],
        };
        cycle.rows.iter().enumerate().map(of_one).collect()
    }

    pub fn force_n(&self) -> f64 {
        self.region_force_n.iter().sum()
    }

    /// Axial force of a foundation where the femur is on the deformable insert, N.
    pub fn force_at_same_pose_n(&self, contact: &mut dyn ContactModel) -> f64 {
        forces(&land(contact, &self.pose)).iter().sum()
    }

    /// A number of every region, the mean weighted by force.
    pub fn mean_by_force(&self, of_regions: [f64; MAX_REGIONS]) -> f64 {
        let pairs = self.region_force_n.iter().zip(of_regions);
        pairs.map(|(force_n, of)| force_n * of).sum::<f64>() / self.force_n()
    }

    /// Takes where the forces act from a contact that presses at this pose.
    pub fn with_arms(mut self, contact: &mut dyn ContactModel, positions: &[Vec3]) -> Self {
        let landing = land(contact, &self.pose);
        let forces = forces(&landing);
        let mut moments = [0.0; MAX_REGIONS];
        for node in &landing.touched {
            let z = positions[node.node as usize].z;
            moments[usize::from(node.region)] -= z * node.force_n.y;
        }
        for region in 0..MAX_REGIONS {
            if forces[region] > 0.0 {
                self.arms_mm[region] = moments[region] / forces[region];
            }
        }
        self
    }

    /// The foundation with the femur lowered and tilted until every region carries its force, from a start that is
    /// near; none where it does not come to that.
    pub fn carried(
        &self,
        contact: &mut dyn ContactModel,
        near_mm: [f64; MAX_REGIONS],
    ) -> Option<Carried> {
        let mut lower_mm = near_mm;
        for _ in 0..ITERATIONS {
            let landing = land(contact, &self.lowered(lower_mm));
            let found = forces(&landing);
            let missing = self.missing_n(found);
            if missing
                .iter()
                .all(|missing| missing.abs() < FORCE_TOLERANCE_N)
            {
                return Some(Carried {
                    area_mm2: landing.touched.iter().map(|node| node.covered_mm2).sum(),
                    peak_mpa: landing.peak_pressure_mpa,
                    lower_mm,
                });
            }
            let probe = lower_mm.map(|lower| lower + PROBE_MM);
            let more = forces(&land(contact, &self.lowered(probe)));
            for region in 0..MAX_REGIONS {
                let stiffness = (more[region] - found[region]) / PROBE_MM;
                let step = missing[region] / stiffness.max(1.0);
                lower_mm[region] += step.clamp(-FARTHEST_MM, FARTHEST_MM);
            }
        }
        None
    }

    /// What regions that carry something are short of, N.
    fn missing_n(&self, found_n: [f64; MAX_REGIONS]) -> [f64; MAX_REGIONS] {
        std::array::from_fn(|region| {
            let wanted_n = self.region_force_n[region];
            if wanted_n > MIN_FORCE_N {
                wanted_n - found_n[region]
            } else {
                0.0
            }
        })
    }

    /// The pose with the femur lowered over every region by so much.
    fn lowered(&self, lower_mm: [f64; MAX_REGIONS]) -> Pose {
        let ([left, right], [left_arm, right_arm]) = (lower_mm, self.arms_mm);
        let mut forces = self.region_force_n.iter();
        let is_on_both = forces.all(|force| *force > MIN_FORCE_N);
        // A side that carries nothing goes along with the other.
        let (tilt, middle) = if is_on_both && (right_arm - left_arm).abs() > 1.0 {
            let tilt = (right - left) / (right_arm - left_arm);
            (tilt, left - tilt * left_arm)
        } else if self.region_force_n[0] > self.region_force_n[1] {
            (0.0, left)
        } else {
            (0.0, right)
        };
        let turn = Rotation3::new(Vec3::new(tilt, 0.0, 0.0)).into_inner();
        Pose::new(
            turn * self.pose.rotation,
            turn * self.pose.translation - Vec3::new(0.0, middle, 0.0),
        )
    }
}

fn land(contact: &mut dyn ContactModel, pose: &Pose) -> ContactResult {
    let motion = RelativeMotion::at_rest(*pose);
    contact.respond(&motion);
    contact.land(&motion)
}

/// Part of the axial force on every region of the surface, N.
fn forces(landing: &ContactResult) -> [f64; MAX_REGIONS] {
    let mut forces_n = [0.0; MAX_REGIONS];
    for node in &landing.touched {
        forces_n[usize::from(node.region)] -= node.force_n.y;
    }
    forces_n
}
