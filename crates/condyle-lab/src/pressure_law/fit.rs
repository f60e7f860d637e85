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
/// The table goes up to this pressure at least.
const MIN_PEAK_MPA: f64 = 1.0;
/// What a bend of the table counts beside a relative error of pressure and area, so that points which no pose feels
/// lie between the others.
const BEND: f64 = 0.01;
/// Step of the differences in the logarithm of strain.
const STEP: f64 = 1e-3;
/// Most rounds of the fit.
const ROUNDS: usize = 15;
/// A round that makes the sum of squares less by no more than this part of it is the last.
const MIN_GAIN: f64 = 1e-4;
/// What is put in for an increment that a table does not carry.
const NOT_CARRIED: f64 = 10.0;

/// A fit of a pressure table on the bodies of a deformable insert.
pub(crate) struct Fit<'a> {
    pub bodies: Bodies<'a>,
    /// The foundation but for its law.
    pub foundation: Foundation,
    pub targets: &'a [Target],
}

/// A table with what it does.
struct Tried {
    /// Logarithms of the strain from each point to the next.
    logarithms: DVector<f64>,
    residuals: DVector<f64>,
    lower_mm: Vec<[f64; MAX_REGIONS]>,
}

impl Tried {
    fn squares(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

impl Fit<'_> {
    /// The table with the least squares of the relative errors of peak pressure and area, where every region carries
    /// the force that it carries on the deformable insert: by Levenberg's and Marquardt's method, from a straight line.
    pub fn table(&self, modulus_mpa: f64) -> PressureTable {
        let pressures = self.pressures_mpa();
        let start = pressures.windows(2);
        let start = start.map(|pair| ((pair[1] - pair[0]) / modulus_mpa).ln());
        let start = DVector::from_iterator(PARTS.len(), start);
        let mut best = self.tried(start, &vec![[0.0; MAX_REGIONS]; self.targets.len()]);
        let mut damping = 1e-2;
        for _ in 0..ROUNDS {
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

    /// A table with less squares; none where none is found.
    fn improved(&self, best: &Tried, damping: &mut f64) -> Option<Tried> {
        let slopes = self.slopes(best);
        let (normal, gradient) = (slopes.tr_mul(&slopes), slopes.tr_mul(&best.residuals));
        for _ in 0..8 {
            let mut damped = normal.clone();
            for i in 0..damped.nrows() {
                damped[(i, i)] += *damping * (normal[(i, i)] + 1e-6);
            }
            let step = damped.cholesky()?.solve(&gradient);
            let next = self.tried(&best.logarithms - step, &best.lower_mm);
            if next.squares() < best.squares() {
                *damping *= 0.2;
                return Some(next);
            }
            *damping *= 5.0;
        }
        None
    }

    /// Derivatives of the residuals by the logarithms.
    fn slopes(&self, at: &Tried) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..at.logarithms.len())
            .map(|i| {
                let mut logarithms = at.logarithms.clone();
                logarithms[i] += STEP;
                (self.tried(logarithms, &at.lower_mm).residuals - &at.residuals) / STEP
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    fn tried(&self, logarithms: DVector<f64>, near_mm: &[[f64; MAX_REGIONS]]) -> Tried {
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
        Tried {
            lower_mm: lower_mm.collect(),
            residuals: DVector::from_vec(residuals),
            logarithms,
        }
    }

    /// Peak and area under the forces of the targets with a table, from starts that are near.
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

    /// Changes of the logarithm of the slope from each piece of the table to the next.
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
pub(crate) struct Target {
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
pub(crate) struct Carried {
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
    contact.evaluate(&motion)
}

/// Part of the axial force on every region of the surface, N.
fn forces(landing: &ContactResult) -> [f64; MAX_REGIONS] {
    let mut forces_n = [0.0; MAX_REGIONS];
    for node in &landing.touched {
        forces_n[usize::from(node.region)] -= node.force_n.y;
    }
    forces_n
}
