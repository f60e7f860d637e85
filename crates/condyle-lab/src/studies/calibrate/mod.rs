//! A pressure table with which the elastic foundation follows the deformable insert.

mod fit;
mod left;
mod page;
mod target;

use std::path::{Path, PathBuf};

use condyle::{
    contact::{
        Bodies, ContactLaw, ContactMemory, ContactModel, Foundation, MAX_REGIONS, PressureLaw,
        PressureTable, confined_modulus,
    },
    evolve::March,
    geometry::{ArticulatingSurface, Insert},
};
use condyle_io::{
    cache::Cache,
    case::{
        Assignment, Case, ContactModelWord, PressureLawChoice, SharedBodies, StrainTable,
        TableError,
    },
};
use serde::Serialize;

use crate::{
    RunError,
    run::{changed, march_watched},
};
use fit::Fit;
use left::{Ran, is_stance};
use target::Target;

pub use left::{CycleLeft, Left, OffInStance};

/// So many increments of stance are fitted to.
const FITTED: usize = 40;

/// What is calibrated.
#[derive(Clone, Debug)]
pub struct CalibrateRequest {
    /// The case file.
    pub case: PathBuf,
    /// What is changed of it.
    pub changes: Vec<Assignment>,
    /// Cases that the table was not fitted to, on which it is tried.
    pub held_out: Vec<PathBuf>,
}

/// What a foundation and the deformable insert do under the same forces, or at the same pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CalibratedIncrement {
    /// Place in the cycle, %.
    pub percent: f64,
    /// Axial force, N.
    pub axial_force_n: f64,
    /// Peak pressure of the deformable insert, MPa.
    pub deformable_peak_mpa: f64,
    /// Of the foundation under the same forces, MPa.
    pub peak_mpa: f64,
    /// Contact area of the deformable insert, mm2.
    pub deformable_area_mm2: f64,
    /// Of the foundation under the same forces, mm2.
    pub area_mm2: f64,
    /// Force of the foundation where the femur is as deep as in the deformable insert, N.
    pub force_at_same_approach_n: f64,
    /// By how much deeper the femur lies in the foundation under the same force, mm.
    pub deeper_mm: f64,
}

/// A calibrated pressure law and what is left.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CalibratedLaw {
    /// Points of overclosure over thickness, and pressure, MPa.
    pub table: Vec<(f64, f64)>,
    /// By how much the peak pressure is off in stance at most, in the first cycle and the last, %.
    pub peak_error_percent: f64,
    /// The increments that it was fitted to.
    pub increments: Vec<CalibratedIncrement>,
    /// A run with it, beside the deformable insert.
    pub left: Left,
    /// A run with the law of the case, or the linear one if the case is that of a deformable insert.
    pub left_before: Left,
    /// Runs of cases that it was not fitted to.
    pub held_out: Vec<HeldOut>,
    /// The case with the table.
    #[serde(skip)]
    pub case: Case,
}

/// A case that a table was not fitted to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeldOut {
    /// The case file.
    pub case: PathBuf,
    /// With the table.
    pub left: Left,
    /// With the case's own law.
    pub left_before: Left,
}

/// Fits a pressure table with which the foundation of a case presses, under the forces of the first cycle of its first
/// activity, as its deformable insert does; then runs both.
///
/// `tell` hears of what is begun.
///
/// # Errors
/// A case that cannot be run, with one model or the other.
pub fn calibrate(
    request: &CalibrateRequest,
    tell: &mut dyn FnMut(&str),
) -> Result<CalibratedLaw, RunError> {
    let case = changed(&request.case, &request.changes)?;
    tell("the deformable insert");
    let mut recorded = Recorded::default();
    let deformable = run(&deformable(&case), &mut recorded)?;
    tell("the fit");
    let (table, increments) = recorded.fitted(&case, &deformable.march);
    tell("the foundation with the table");
    let mut calibrated = with_table(&case, table.clone(), None);
    let left = Left::between(&run_quietly(&calibrated)?, &deformable);
    let left_before = Left::between(&run_quietly(&foundation(&case))?, &deformable);
    let worst = |cycle: &CycleLeft| cycle.peak_pressure.most_percent;
    let peak_error_percent = worst(&left.first_cycle).max(worst(&left.last_cycle));
    // As it is said, rather than to the last bit.
    let said = (peak_error_percent * 10.0).ceil() / 10.0;
    calibrated = with_table(&case, table.clone(), Some(said));
    let held_out = request.held_out.iter().map(|path| {
        tell(&format!("{}", path.display()));
        held_out(path, &table)
    });
    Ok(CalibratedLaw {
        peak_error_percent: said,
        increments,
        left,
        left_before,
        held_out: held_out.collect::<Result<_, _>>()?,
        table: table.points().to_vec(),
        case: calibrated,
    })
}

impl CalibratedLaw {
    /// The table as a CSV file for `[contact] strain_table_file`.
    pub fn to_csv(&self) -> String {
        match &self.case.contact.law {
            PressureLawChoice::TabulatedStrain(table) => table.to_csv(),
            _ => String::new(),
        }
    }
}

fn held_out(path: &Path, table: &PressureTable) -> Result<HeldOut, RunError> {
    let case = changed(path, &[])?;
    let deformable = run_quietly(&deformable(&case))?;
    let calibrated = run_quietly(&with_table(&case, table.clone(), None))?;
    let before = run_quietly(&foundation(&case))?;
    Ok(HeldOut {
        case: path.to_owned(),
        left: Left::between(&calibrated, &deformable),
        left_before: Left::between(&before, &deformable),
    })
}

fn deformable(case: &Case) -> Case {
    let mut case = case.clone();
    case.contact.model = ContactModelWord::Deformable;
    case
}

fn foundation(case: &Case) -> Case {
    let mut case = case.clone();
    case.contact.model = ContactModelWord::Foundation;
    case
}

fn with_table(case: &Case, points: PressureTable, peak_error_percent: Option<f64>) -> Case {
    let mut case = foundation(case);
    let error = TableError { peak_error_percent };
    case.contact.law = PressureLawChoice::TabulatedStrain(StrainTable { points, error });
    case
}

/// What the first cycle on a deformable insert was, and on what.
#[derive(Default)]
struct Recorded {
    insert: Option<Insert>,
    targets: Vec<Target>,
}

fn run_quietly(case: &Case) -> Result<Ran, RunError> {
    run(case, &mut Recorded::default())
}

/// Runs a case to its end.
fn run(case: &Case, recorded: &mut Recorded) -> Result<Ran, RunError> {
    let watch = &mut |march: &March| recorded.see(march);
    let (march, summary) = march_watched(case, &Cache::of_user(), &SharedBodies::default(), watch)?;
    Ok(Ran { march, summary })
}

impl Recorded {
    /// Keeps the insert before it wears, and the first cycle.
    fn see(&mut self, march: &March) {
        if self.insert.is_none() {
            self.insert = Some(march.insert().clone());
        } else if self.targets.is_empty() {
            let cycle = march.last_cycle();
            self.targets = cycle.iter().flat_map(Target::of).collect();
        }
    }

    /// The table that is fitted to some increments of stance, and what it does in them.
    fn fitted(&self, case: &Case, march: &March) -> (PressureTable, Vec<CalibratedIncrement>) {
        let insert = self.insert.as_ref().expect("a run has an insert");
        let surface = insert.surface();
        let bodies = Bodies {
            femur: march.femur(),
            insert,
            surface: &surface,
        };
        let material = &case.material;
        let modulus_mpa = confined_modulus(material.youngs_modulus_mpa, material.poissons_ratio);
        let mut law = foundation(case).foundation();
        law.pressure = PressureLaw::Linear { modulus_mpa };
        // Forces are met more exactly than extrapolated samples give them.
        law.sample_reuse_mm = 0.0;
        let targets =
            self.few_that_are_carried(law.contact(bodies, ContactMemory::default()), &surface);
        let fit = Fit {
            bodies,
            foundation: law,
            targets: &targets,
        };
        let table = fit.table(modulus_mpa);
        let increments = increments(&fit, &table);
        (table, increments)
    }

    /// Few increments of stance whose forces a foundation carries, with where they act.
    fn few_that_are_carried(
        &self,
        mut contact: Box<dyn ContactModel + '_>,
        surface: &ArticulatingSurface,
    ) -> Vec<Target> {
        let few = self.few_of_stance().into_iter();
        let armed = few.map(|target| target.with_arms(contact.as_mut(), &surface.positions));
        let mut armed: Vec<Target> = armed.collect();
        armed.retain(|target| {
            target
                .carried(contact.as_mut(), [0.0; MAX_REGIONS])
                .is_some()
        });
        armed
    }

    /// Increments of stance, evenly.
    fn few_of_stance(&self) -> Vec<Target> {
        let highest_n = self.targets.iter().map(Target::force_n).fold(0.0, f64::max);
        let stance = || {
            let targets = self.targets.iter();
            targets.filter(|target| is_stance(target.force_n(), highest_n))
        };
        let every = stance().count().div_ceil(FITTED).max(1);
        stance().step_by(every).cloned().collect()
    }
}

/// What a table does in the increments that it was fitted to.
fn increments(fit: &Fit<'_>, table: &PressureTable) -> Vec<CalibratedIncrement> {
    let near = vec![[0.0; MAX_REGIONS]; fit.targets.len()];
    let carried = fit.carried(table, &near);
    let law = Foundation {
        pressure: PressureLaw::TabulatedStrain(table.clone()),
        ..fit.foundation.clone()
    };
    let mut contact = law.contact(fit.bodies, ContactMemory::default());
    let pairs = fit.targets.iter().zip(carried);
    let told = pairs.filter_map(|(target, carried)| {
        let carried = carried?;
        let force_n = target.force_at_same_pose_n(contact.as_mut());
        Some(CalibratedIncrement {
            percent: target.percent,
            axial_force_n: target.force_n(),
            deformable_peak_mpa: target.peak_mpa,
            peak_mpa: carried.peak_mpa,
            deformable_area_mm2: target.area_mm2,
            area_mm2: carried.area_mm2,
            force_at_same_approach_n: force_n,
            deeper_mm: target.mean_by_force(carried.lower_mm),
        })
    });
    told.collect()
}
