//! A pressure table by least squares, so that a foundation presses as a deformable insert does.

use condyle::{
    Vec3,
    contact::{
        Bodies, ContactLaw, ContactMemory, ContactModel, ContactResult, Foundation, MAX_REGIONS,
        PressureLaw, PressureTable,
    },
    evolve::SolvedCycle,
    spatial::{Pose, RelativeMotion},
};
use nalgebra::{DMatrix, DVector, Rotation3};

/// Pressures of the table's points, as parts of the highest pressure of the deformable insert.
const PARTS: [f64; 9] = [0.03, 0.08, 0.15, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0];
/// Smallest pressure at the end of the table.
const MIN_PEAK_MPA: f64 = 1.0;
/// Weight of the curvature of the table against relative errors of pressure and area: it places points that no pose
/// reaches between the others.
const BEND: f64 = 0.01;
/// Step of the finite differences in the logarithm of strain.
const STEP: f64 = 1e-3;
const MAX_ROUNDS: usize = 15;
/// The fit ends with an iteration that reduces the sum of squares by a smaller part than this.
const MIN_GAIN: f64 = 1e-4;
/// Residual of an increment in which a table cannot carry the forces: far above any relative error.
const NOT_CARRIED: f64 = 10.0;

/// A fit of a pressure table on the bodies of a deformable insert.
pub(crate) struct Fit<'a> {
    pub bodies: Bodies<'a>,
    /// The foundation; its pressure law is replaced.
    pub foundation: Foundation,
    pub targets: &'a [Target],
}

/// A table, by its parameters, and its residuals.
struct Trial {
    /// Logarithms of the strain from each point to the next.
    logarithms: DVector<f64>,
    residuals: DVector<f64>,
    lower_mm: Vec<[f64; MAX_REGIONS]>,
}

impl Trial {
    fn squares(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

impl Fit<'_> {
    /// Returns the table that minimises the sum of squares of the relative errors of peak pressure and area, with
    /// every region under the force that it carries on the deformable insert: by the Levenberg-Marquardt method, from
    /// the linear law.
    ///
    /// The parameters are logarithms of strain increments, so that every table rises.
    pub fn table(&self, modulus_mpa: f64) -> PressureTable {
        let pressures = self.pressures_mpa();
        let start = pressures.windows(2);
        let start = start.map(|pair| ((pair[1] - pair[0]) / modulus_mpa).ln());
        let start = DVector::from_iterator(PARTS.len(), start);
        let mut best = self.trial(start, &vec![[0.0; MAX_REGIONS]; self.targets.len()]);
        let mut damping = 1e-2;
        for _ in 0..MAX_ROUNDS {
            let Some(next) = self.improved(&best, &mut damping) else {
                break;
            };
            let gain = 1.0 - next.squares() / best.squares();
            best = next;
            if gain < MIN_GAIN {
                break;
            }
        }
        self.table_of(&best.logarithms)
    }

    /// Returns a table with a smaller sum of squares, if one is found.
    fn improved(&self, best: &Trial, damping: &mut f64) -> Option<Trial> {
        let slopes = self.slopes(best);
        let (normal, gradient) = (slopes.tr_mul(&slopes), slopes.tr_mul(&best.residuals));
        for _ in 0..8 {
            let mut damped = normal.clone();
            for i in 0..damped.nrows() {
                // Scaled by the diagonal; the constant keeps parameters without an effect in place.
                damped[(i, i)] += *damping * (normal[(i, i)] + 1e-6);
            }
            let step = damped.cholesky()?.solve(&gradient);
            let next = self.trial(&best.logarithms - step, &best.lower_mm);
            // Short steps along the gradient where the slopes mislead, Gauss-Newton steps where they hold.
            if next.squares() < best.squares() {
                *damping *= 0.2;
                return Some(next);
            }
            *damping *= 5.0;
        }
        None
    }

    /// Derivatives of the residuals, by forward differences.
    fn slopes(&self, at: &Trial) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..at.logarithms.len())
            .map(|i| {
                let mut logarithms = at.logarithms.clone();
                logarithms[i] += STEP;
                (self.trial(logarithms, &at.lower_mm).residuals - &at.residuals) / STEP
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    fn trial(&self, logarithms: DVector<f64>, near_mm: &[[f64; MAX_REGIONS]]) -> Trial {
        let carried = self.carried(&self.table_of(&logarithms), near_mm);
        let mut residuals = Vec::new();
        for (carried, target) in carried.iter().zip(self.targets) {
            let errors = carried.map_or([NOT_CARRIED; 2], |carried| {
                [
                    (carried.peak_mpa / target.peak_mpa).ln(),
                    (carried.area_mm2 / target.area_mm2).ln(),
                ]
            });
            residuals.extend(errors);
        }
        let weight = BEND * (self.targets.len() as f64).sqrt();
        residuals.extend(self.bends(&logarithms).map(|bend| weight * bend));
        let lower_mm = carried.iter().zip(near_mm);
        let lower_mm = lower_mm.map(|(carried, near)| carried.map_or(*near, |it| it.lower_mm));
        Trial {
            lower_mm: lower_mm.collect(),
            residuals: DVector::from_vec(residuals),
            logarithms,
        }
    }

    /// Peak and area under the forces of the targets with a table, starting from nearby depths.
    pub fn carried(
        &self,
        table: &PressureTable,
        near_mm: &[[f64; MAX_REGIONS]],
    ) -> Vec<Option<Carried>> {
        let law = Foundation {
            pressure: PressureLaw::TabulatedStrain(table.clone()),
            ..self.foundation.clone()
        };
        let mut contact = law.contact(self.bodies, ContactMemory::default());
        let places = self.targets.iter().zip(near_mm);
        let carried = places.map(|(target, near)| target.carried(contact.as_mut(), *near));
        carried.collect()
    }

    /// Second differences of the logarithm of the slope along the table.
    fn bends(&self, logarithms: &DVector<f64>) -> impl Iterator<Item = f64> {
        let pressures = self.pressures_mpa();
        let pieces = pressures.windows(2).zip(logarithms.iter());
        let slopes: Vec<f64> = pieces
            .map(|(pair, logarithm)| (pair[1] - pair[0]).ln() - logarithm)
            .collect();
        let bends: Vec<f64> = slopes
            .windows(3)
            .map(|three| three[2] - 2.0 * three[1] + three[0])
            .collect();
        bends.into_iter()
    }

    fn table_of(&self, logarithms: &DVector<f64>) -> PressureTable {
        let mut strain = 0.0;
        let mut points = vec![(0.0, 0.0)];
        for (pressure, logarithm) in self.pressures_mpa()[1..].iter().zip(logarithms.iter()) {
            strain += logarithm.exp();
            points.push((strain, *pressure));
        }
        PressureTable::new(points).expect("exponentials and pressures rise")
    }

    /// Pressures of the table's points, from zero.
    fn pressures_mpa(&self) -> Vec<f64> {
        let peaks = self.targets.iter().map(|target| target.peak_mpa);
        let highest = peaks.fold(MIN_PEAK_MPA, f64::max);
        let above = PARTS.iter().map(|part| part * highest);
        [0.0].into_iter().chain(above).collect()
    }
}

/// Tolerance of the forces on the regions, N.
const FORCE_TOLERANCE_N: f64 = 0.05;
/// A region that carries less counts as unloaded, N.
const MIN_FORCE_N: f64 = 1.0;
const MAX_ITERATIONS: usize = 30;
/// Lowering of the femur by which the stiffness of the regions is found, mm.
const PROBE_MM: f64 = 1e-4;
/// Largest motion of the femur in an iteration, mm.
const MAX_STEP_MM: f64 = 0.03;

/// The state of a deformable insert in an increment.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    pub percent: f64,
    pub pose: Pose,
    /// Part of the axial force on every region of the surface, N.
    pub region_force_n: [f64; MAX_REGIONS],
    pub area_mm2: f64,
    pub peak_mpa: f64,
    /// The z at which the force of every region acts, mm.
    pub arms_mm: [f64; MAX_REGIONS],
}

/// The state of a foundation under the same forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    pub area_mm2: f64,
    pub peak_mpa: f64,
    /// Lowering of the femur over every region from its pose on the deformable insert, mm.
    pub lower_mm: [f64; MAX_REGIONS],
}

impl Target {
    /// Returns the targets of a cycle solved on a deformable insert.
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

    /// Axial force of a foundation at the pose on the deformable insert, N.
    pub fn force_at_same_pose_n(&self, contact: &mut dyn ContactModel) -> f64 {
        forces(&evaluate(contact, &self.pose)).iter().sum()
    }

    /// Returns the mean over the regions, weighted by force.
    pub fn mean_by_force(&self, of_regions: [f64; MAX_REGIONS]) -> f64 {
        let pairs = self.region_force_n.iter().zip(of_regions);
        pairs.map(|(force_n, of)| force_n * of).sum::<f64>() / self.force_n()
    }

    /// Takes the points of action from the contact at this pose.
    pub fn with_arms(mut self, contact: &mut dyn ContactModel, positions: &[Vec3]) -> Self {
        let result = evaluate(contact, &self.pose);
        let forces = forces(&result);
        let mut moments = [0.0; MAX_REGIONS];
        for node in &result.touched {
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

    /// Lowers and tilts the femur until every region carries its force, starting from nearby depths; none if that does
    /// not converge.
    pub fn carried(
        &self,
        contact: &mut dyn ContactModel,
        near_mm: [f64; MAX_REGIONS],
    ) -> Option<Carried> {
        let mut lower_mm = near_mm;
        for _ in 0..MAX_ITERATIONS {
            let result = evaluate(contact, &self.lowered(lower_mm));
            let found = forces(&result);
            let missing: [f64; MAX_REGIONS] = std::array::from_fn(|region| {
                let target_n = self.region_force_n[region];
                // The pose over an unloaded region follows from the other one.
                if target_n > MIN_FORCE_N {
                    target_n - found[region]
                } else {
                    0.0
                }
            });
            let mut missing_n = missing.iter();
            if missing_n.all(|missing| missing.abs() < FORCE_TOLERANCE_N) {
                return Some(Carried {
                    area_mm2: result.touched.iter().map(|node| node.covered_mm2).sum(),
                    peak_mpa: result.peak_pressure_mpa,
                    lower_mm,
                });
            }
            let probe = lower_mm.map(|lower| lower + PROBE_MM);
            let more = forces(&evaluate(contact, &self.lowered(probe)));
            for region in 0..MAX_REGIONS {
                // A region out of contact has no stiffness; it approaches by bounded steps.
                let stiffness = (more[region] - found[region]) / PROBE_MM;
                let step = missing[region] / stiffness.max(1.0);
                lower_mm[region] += step.clamp(-MAX_STEP_MM, MAX_STEP_MM);
            }
        }
        None
    }

    /// Returns the pose with the femur lowered over every region.
    fn lowered(&self, lower_mm: [f64; MAX_REGIONS]) -> Pose {
        let ([left, right], [left_arm, right_arm]) = (lower_mm, self.arms_mm);
        let mut forces = self.region_force_n.iter();
        let is_on_both = forces.all(|force| *force > MIN_FORCE_N);
        // An unloaded region follows the other one.
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

fn evaluate(contact: &mut dyn ContactModel, pose: &Pose) -> ContactResult {
    let motion = RelativeMotion::at_rest(*pose);
    contact.respond(&motion);
    contact.evaluate(&motion)
}

/// Returns the part of the axial force on every region of the surface, N.
fn forces(result: &ContactResult) -> [f64; MAX_REGIONS] {
    let mut forces_n = [0.0; MAX_REGIONS];
    for node in &result.touched {
        forces_n[usize::from(node.region)] -= node.force_n.y;
    }
    forces_n
}
