//! A pressure table with which the elastic foundation follows the deformable insert.

pub(crate) mod fit;

use condyle_results::catalogue;
use std::path::{Path, PathBuf};

use condyle::{
    contact::{
        Bodies, ContactLaw, ContactMemory, ContactModel, Foundation, MAX_REGIONS, PressureLaw,
        PressureTable, confined_modulus,
    },
    evolve::March,
    geometry::{ArticulatingSurface, Insert},
    machine::{
        CycleRow, JointIndex,
        knee::{AP, IE, KNEE},
    },
};
use condyle_case::{
    cache::Cache,
    case::{
        Assignment, Case, ContactModelChoice, DeformableContact, FoundationContact,
        PressureLawChoice, SharedBodies, StrainTable, TableError,
    },
};
use condyle_results::Summary;
use serde::Serialize;

use crate::{
    markdown::aligned,
    pressure_law::fit::{Fit, Target},
    run::{error::RunError, running::march_watched},
};

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
    let case = Case::read_changed(&request.case, &request.changes)?;
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
    /// The table as a CSV file for `[contact.foundation] strain_table_file`.
    pub fn to_csv(&self) -> String {
        match self.case.contact.law() {
            Some(PressureLawChoice::TabulatedStrain(table)) => table.to_csv(),
            _ => String::new(),
        }
    }
}

fn held_out(path: &Path, table: &PressureTable) -> Result<HeldOut, RunError> {
    let case = Case::read_changed(path, &[])?;
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
    if case.contact.deformable().is_none() {
        case.contact.model = ContactModelChoice::Deformable(DeformableContact::ELASTIC);
    }
    case
}

fn foundation(case: &Case) -> Case {
    let law = case.contact.law().cloned();
    with_law(case, law.unwrap_or(PressureLawChoice::Linear))
}

fn with_law(case: &Case, law: PressureLawChoice) -> Case {
    let mut case = case.clone();
    case.contact.model = ContactModelChoice::Foundation(FoundationContact { law });
    case
}

fn with_table(case: &Case, points: PressureTable, peak_error_percent: Option<f64>) -> Case {
    let error = TableError { peak_error_percent };
    with_law(
        case,
        PressureLawChoice::TabulatedStrain(StrainTable { points, error }),
    )
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

/// An increment with at least this part of the cycle's highest axial force is one of stance.
const STANCE: f64 = 0.2;

/// What a number is off by over the increments of stance, %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OffInStance {
    /// Root of the mean square.
    pub mean_percent: f64,
    /// The largest, without its sign.
    pub most_percent: f64,
    /// Of the highest value of the cycle, with its sign.
    pub of_highest_percent: f64,
}

/// What a cycle of the rigid model is off by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CycleLeft {
    /// Peak pressure.
    pub peak_pressure: OffInStance,
    /// Contact area.
    pub contact_area: OffInStance,
    /// Root of the mean square over the whole cycle, mm.
    pub ap_mm: f64,
    /// The same, degrees.
    pub ie_deg: f64,
}

/// What a run of the rigid model is off by.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Left {
    /// The first cycle.
    pub first_cycle: CycleLeft,
    /// The last cycle solved.
    pub last_cycle: CycleLeft,
    /// Mass lost on the deformable insert, mg.
    pub deformable_mass_loss_mg: f64,
    /// Mass lost with the foundation, mg.
    pub mass_loss_mg: f64,
    /// What that is off by, %.
    pub mass_loss_percent: f64,
    /// Deepest wear on the deformable insert, mm.
    pub deformable_max_depth_mm: f64,
    /// Deepest wear with the foundation, mm.
    pub max_depth_mm: f64,
    /// What that is off by, %.
    pub max_depth_percent: f64,
    /// Seconds of the solver on the deformable insert.
    pub deformable_wall_s: f64,
    /// Seconds of the solver with the foundation.
    pub wall_s: f64,
}

/// A march that is done, and what it came to.
pub(crate) struct Ran {
    pub march: March,
    pub summary: Summary,
}

impl Left {
    /// What is left between two runs that are done.
    pub(crate) fn between(foundation: &Ran, deformable: &Ran) -> Self {
        let (found, wanted) = (&foundation.summary, &deformable.summary);
        let cycles = first_and_last(&foundation.march)
            .into_iter()
            .zip(first_and_last(&deformable.march));
        let [first_cycle, last_cycle] = <[CycleLeft; 2]>::try_from(
            cycles
                .map(|(found, wanted)| CycleLeft::between(found, wanted))
                .collect::<Vec<_>>(),
        )
        .expect("a first and a last cycle");
        Self {
            first_cycle,
            last_cycle,
            deformable_mass_loss_mg: wanted[&catalogue::MASS_LOSS_MG],
            mass_loss_mg: found[&catalogue::MASS_LOSS_MG],
            mass_loss_percent: off_percent(
                found[&catalogue::MASS_LOSS_MG],
                wanted[&catalogue::MASS_LOSS_MG],
            ),
            deformable_max_depth_mm: wanted[&catalogue::MAX_DEPTH_MM],
            max_depth_mm: found[&catalogue::MAX_DEPTH_MM],
            max_depth_percent: off_percent(
                found[&catalogue::MAX_DEPTH_MM],
                wanted[&catalogue::MAX_DEPTH_MM],
            ),
            deformable_wall_s: wanted[&catalogue::WALL_S],
            wall_s: found[&catalogue::WALL_S],
        }
    }
}

impl CycleLeft {
    fn between(found: &[CycleRow], wanted: &[CycleRow]) -> Self {
        let distance = |joint: JointIndex| {
            let pairs = found.iter().zip(wanted);
            let squares = pairs
                .map(|(one, other)| joint.of(&one.positions) - joint.of(&other.positions))
                .map(|off| KNEE.joint(joint).kind().in_files(off).powi(2));
            (squares.sum::<f64>() / wanted.len() as f64).sqrt()
        };
        Self {
            peak_pressure: off_in_stance(found, wanted, |row| row.peak_pressure_mpa),
            contact_area: off_in_stance(found, wanted, |row| row.contact_area_mm2),
            ap_mm: distance(AP),
            ie_deg: distance(IE),
        }
    }
}

/// Rows of the first activity's first and last cycle.
fn first_and_last(march: &March) -> [&[CycleRow]; 2] {
    let cycles = march.state().activities[0].first_and_last.as_ref();
    let (first, last) = cycles.expect("a march that is done has solved cycles");
    [&first.rows, &last.rows]
}

/// Which rows of a cycle are of stance.
pub(crate) fn is_stance(force_n: f64, highest_n: f64) -> bool {
    force_n >= STANCE * highest_n
}

fn off_in_stance(
    found: &[CycleRow],
    wanted: &[CycleRow],
    value: fn(&CycleRow) -> f64,
) -> OffInStance {
    let highest =
        |rows: &[CycleRow], value: fn(&CycleRow) -> f64| rows.iter().map(value).fold(0.0, f64::max);
    let highest_n = highest(wanted, |row| row.axial_force_n);
    let pairs = found.iter().zip(wanted);
    let stance = pairs.filter(|(_, wanted)| is_stance(wanted.axial_force_n, highest_n));
    let off: Vec<f64> = stance
        .map(|(found, wanted)| off_percent(value(found), value(wanted)))
        .collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    OffInStance {
        mean_percent: (squares / off.len() as f64).sqrt(),
        most_percent: off.iter().fold(0.0, |most, off| off.abs().max(most)),
        of_highest_percent: off_percent(highest(found, value), highest(wanted, value)),
    }
}

fn off_percent(found: f64, wanted: f64) -> f64 {
    100.0 * (found / wanted - 1.0)
}

impl CalibratedLaw {
    /// The page: what is left of a run, increment by increment, on other cases, and the table.
    pub fn markdown(&self) -> String {
        let mut page = String::from("# Calibrated pressure law\n\n");
        page += &format!(
            "With this table the peak pressure of the rigid model is off by {} % at most in stance, in the first cycle and the last.\n\n",
            self.peak_error_percent
        );
        page += "Off the deformable insert, with the law before and with the table; stance has a fifth of the highest axial force and more:\n\n";
        page += &self.table_of_left();
        if !self.held_out.is_empty() {
            page += "\nCases that the table was not fitted to, with their own law and with the table:\n";
            page += &self.held_out.iter().map(of_held_out).collect::<String>();
        }
        page += "\nUnder the forces of the deformable insert, where it was fitted (unworn):\n\n";
        page += &self.table_of_increments();
        page += "\nThe table:\n\n";
        page += &self.table_of_points();
        page
    }

    /// What is left, as a table.
    pub fn table_of_left(&self) -> String {
        of_left(&self.left_before, &self.left)
    }

    fn table_of_increments(&self) -> String {
        let head = [
            "% of cycle",
            "axial force, N",
            "peak, MPa: deformable",
            "table",
            "area, mm2: deformable",
            "table",
            "force at the same approach, N",
            "deeper by, mm",
        ];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(self.increments.iter().map(of_increment));
        aligned(&rows)
    }

    fn table_of_points(&self) -> String {
        let head = ["overclosure over thickness", "pressure, MPa"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let points = self.table.iter();
        rows.extend(points.map(|(d, p)| vec![format!("{d:.6}"), format!("{p:.3}")]));
        aligned(&rows)
    }
}

fn of_increment(increment: &CalibratedIncrement) -> Vec<String> {
    vec![
        format!("{:.1}", increment.percent),
        format!("{:.0}", increment.axial_force_n),
        format!("{:.2}", increment.deformable_peak_mpa),
        format!("{:.2}", increment.peak_mpa),
        format!("{:.1}", increment.deformable_area_mm2),
        format!("{:.1}", increment.area_mm2),
        format!("{:.0}", increment.force_at_same_approach_n),
        format!("{:+.4}", increment.deeper_mm),
    ]
}

fn of_held_out(held_out: &HeldOut) -> String {
    let case = held_out.case.display();
    let table = of_left(&held_out.left_before, &held_out.left);
    format!("\n`{case}`\n\n{table}")
}

fn of_left(before: &Left, after: &Left) -> String {
    let [mut rows, after] = [before, after].map(|left| {
        let [mut said, of_run] = [of_cycles(left), of_run(left)];
        said.extend(of_run);
        said
    });
    for (row, after) in rows.iter_mut().zip(after) {
        row.extend(after.into_iter().skip(1));
    }
    rows.insert(0, ["", "law before", "table"].map(str::to_owned).to_vec());
    aligned(&rows)
}

/// What is left of the first and the last cycle.
fn of_cycles(left: &Left) -> Vec<Vec<String>> {
    let (first, last) = (&left.first_cycle, &left.last_cycle);
    vec![
        row(
            "peak pressure in stance, first cycle",
            in_stance(first.peak_pressure),
        ),
        row("the same, last cycle", in_stance(last.peak_pressure)),
        row(
            "contact area in stance, first cycle",
            in_stance(first.contact_area),
        ),
        row("the same, last cycle", in_stance(last.contact_area)),
        row("AP, first cycle", format!("{:.3} mm", first.ap_mm)),
        row("IE, first cycle", format!("{:.3} degrees", first.ie_deg)),
    ]
}

/// What is left of the whole run.
fn of_run(left: &Left) -> Vec<Vec<String>> {
    let beside = |percent: f64, found: String, wanted: String| {
        format!("{percent:+.2} % ({found}, {wanted} on the deformable insert)")
    };
    let mass = beside(
        left.mass_loss_percent,
        format!("{:.2} mg", left.mass_loss_mg),
        format!("{:.2}", left.deformable_mass_loss_mg),
    );
    let depth = beside(
        left.max_depth_percent,
        format!("{:.4} mm", left.max_depth_mm),
        format!("{:.4}", left.deformable_max_depth_mm),
    );
    let (wall_s, deformable_s) = (left.wall_s, left.deformable_wall_s);
    let time = format!("{wall_s:.2} s ({deformable_s:.2} s on the deformable insert)");
    vec![
        row("mass lost", mass),
        row("deepest wear", depth),
        row("time", time),
    ]
}

fn row(what: &str, said: String) -> Vec<String> {
    vec![what.to_owned(), said]
}

fn in_stance(off: OffInStance) -> String {
    let OffInStance {
        mean_percent,
        most_percent,
        of_highest_percent,
    } = off;
    format!(
        "{mean_percent:.1} % (most {most_percent:.1} %, of the highest {of_highest_percent:+.1} %)"
    )
}
