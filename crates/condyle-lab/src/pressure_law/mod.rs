//! A pressure table with which the elastic foundation reproduces the peak pressure and area of the deformable insert.

pub(crate) mod fit;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use condyle::{
    contact::{
        Bodies, ContactLaw, ContactMemory, Foundation, MAX_REGIONS, PressureLaw, PressureTable,
        confined_modulus,
    },
    evolve::March,
    geometry::Insert,
    machine::{CycleRow, Drive, JointIndex},
};
use condyle_case::{
    cache::Cache,
    case::{
        Assignment, Case, ContactModelChoice, DeformableContact, FoundationContact,
        PressureLawChoice, SharedBodies, StrainTable, TableError,
    },
};
use condyle_results::{
    Summary,
    catalogue::{MASS_LOSS_MG, MAX_DEPTH_MM, WALL_S},
};
use serde::Serialize;

use crate::{
    markdown::aligned,
    pressure_law::fit::{Fit, Target},
    run::{error::RunError, running::march_watched},
};

/// Largest number of increments of stance to which the table is fitted.
const MAX_FITTED: usize = 40;
/// Increments with at least this part of the cycle's highest axial force are stance.
const STANCE: f64 = 0.2;

/// The foundation and the deformable insert in one increment, under the same forces or at the same pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct FittedIncrement {
    percent: f64,
    axial_force_n: f64,
    deformable_peak_mpa: f64,
    peak_mpa: f64,
    deformable_area_mm2: f64,
    area_mm2: f64,
    /// Force of the foundation with the femur as deep as in the deformable insert.
    force_at_same_approach_n: f64,
    /// Additional depth of the femur in the foundation under the same force.
    deeper_mm: f64,
}

/// A calibrated pressure law and its remaining errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CalibratedLaw {
    /// Points of overclosure over thickness, and pressure, MPa.
    table: Vec<(f64, f64)>,
    /// Largest error of the peak pressure in stance, in the first cycle and the last, %, rounded up to a tenth.
    pub peak_error_percent: f64,
    increments: Vec<FittedIncrement>,
    /// Errors of a run with the table.
    left: RunErrors,
    /// Errors of a run with the law of the case, or the linear one if the case is that of a deformable insert.
    left_before: RunErrors,
    held_out: Vec<HeldOut>,
    /// The case with the table.
    #[serde(skip)]
    pub case: Case,
}

/// A case to which the table was not fitted.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct HeldOut {
    case: PathBuf,
    /// Errors with the table.
    left: RunErrors,
    /// Errors with the case's own law.
    left_before: RunErrors,
}

/// Fits a pressure table with which the foundation of the changed case at `case_path` presses as its deformable insert does,
/// under the forces of the first cycle; then runs both.
///
/// The table is tested on the cases `held_out` too, to which it is not fitted. `on_step` receives the name of each step as
/// it begins.
///
/// # Errors
/// A case with several activities, or one that does not run with one of the two models.
pub fn calibrate(
    case_path: &Path,
    changes: &[Assignment],
    held_out: &[PathBuf],
    on_step: &mut dyn FnMut(&str),
) -> Result<CalibratedLaw, RunError> {
    let case = Case::read_changed(case_path, changes)?;
    check_activities(&case)?;
    on_step("the deformable insert");
    // The insert before it wears, and its first cycle: the table is fitted to the unworn bodies.
    let (mut insert, mut targets) = (None, Vec::new());
    let deformable = run(&with_deformable(&case), &mut |march| {
        if insert.is_none() {
            insert = Some(march.insert().clone());
        } else if targets.is_empty() {
            targets = march.last_cycle().iter().flat_map(Target::of).collect();
        }
    })?;
    let insert = insert.expect("a run has an insert");
    on_step("the fit");
    let (table, increments) = fitted(&case, &deformable.march, &insert, &targets);
    on_step("the foundation with the table");
    let (left, left_before) = errors(&case, &table, &deformable)?;
    let worst = |cycle: &CycleErrors| cycle.peak_pressure.most_percent;
    let worst = worst(&left.first_cycle).max(worst(&left.last_cycle));
    let peak_error_percent = (worst * 10.0).ceil() / 10.0;
    let mut tested = Vec::new();
    for path in held_out {
        on_step(&path.display().to_string());
        let case = Case::read_changed(path, &[])?;
        check_activities(&case)?;
        let deformable = run(&with_deformable(&case), &mut |_| ())?;
        let (left, left_before) = errors(&case, &table, &deformable)?;
        tested.push(HeldOut {
            case: path.to_owned(),
            left,
            left_before,
        });
    }
    Ok(CalibratedLaw {
        peak_error_percent,
        increments,
        left,
        left_before,
        held_out: tested,
        table: table.points().to_vec(),
        case: with_table(&case, table, Some(peak_error_percent)),
    })
}

/// Rejects several activities: fit and errors are those of the cycles of one.
fn check_activities(case: &Case) -> Result<(), RunError> {
    let count = case.activities.len();
    if count < 2 {
        return Ok(());
    }
    let message = format!(
        "the table is fitted to one activity, and the case has {count}; give a case of the activity with the highest pressure"
    );
    Err(RunError::Case(case.problem_at("activity", message)))
}

/// Errors of the foundation with a table, and with the law of the case.
fn errors(
    case: &Case,
    table: &PressureTable,
    deformable: &Ran,
) -> Result<(RunErrors, RunErrors), RunError> {
    let error_of = |case: &Case| -> Result<RunErrors, RunError> {
        Ok(RunErrors::between(&run(case, &mut |_| ())?, deformable))
    };
    let left = error_of(&with_table(case, table.clone(), None))?;
    Ok((left, error_of(&with_foundation(case))?))
}

fn with_deformable(case: &Case) -> Case {
    let mut case = case.clone();
    if case.contact.deformable().is_none() {
        case.contact.model = ContactModelChoice::Deformable(DeformableContact::ELASTIC);
    }
    case
}

/// Returns the case with a foundation and its own law, or the linear one.
fn with_foundation(case: &Case) -> Case {
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
    let table = StrainTable { points, error };
    with_law(case, PressureLawChoice::TabulatedStrain(table))
}

pub(crate) struct Ran {
    pub march: March,
    pub summary: Summary,
}

fn run(case: &Case, watch: &mut dyn FnMut(&March)) -> Result<Ran, RunError> {
    let (cache, bodies) = (Cache::of_user(), SharedBodies::default());
    let (run, summary) = march_watched(case, &cache, &bodies, watch)?;
    Ok(Ran {
        march: run.march,
        summary,
    })
}

/// Returns the table fitted to some increments of stance, and its errors in them.
fn fitted(
    case: &Case,
    march: &March,
    insert: &Insert,
    targets: &[Target],
) -> (PressureTable, Vec<FittedIncrement>) {
    let surface = insert.surface();
    let bodies = Bodies {
        counterface: march.counterface(),
        insert,
        surface: &surface,
    };
    let material = &case.material;
    let modulus_mpa = confined_modulus(material.youngs_modulus_mpa, material.poissons_ratio);
    let mut law = with_foundation(case).foundation(insert);
    law.pressure = PressureLaw::Linear { modulus_mpa };
    // Forces are balanced more exactly than extrapolated samples of the femur allow.
    law.settings.sample_reuse_mm = 0.0;
    let mut contact = law.contact(bodies, ContactMemory::default());
    let highest_n = targets.iter().map(Target::force_n).fold(0.0, f64::max);
    let stance = targets.iter();
    let stance = stance.filter(|target| target.force_n() >= STANCE * highest_n);
    let every = stance.clone().count().div_ceil(MAX_FITTED).max(1);
    let few = stance.step_by(every).cloned();
    let armed = few.map(|target| target.with_arms(contact.as_mut(), &surface.positions));
    let mut targets: Vec<Target> = armed.collect();
    targets.retain(|target| {
        let carried = target.carried(contact.as_mut(), [0.0; MAX_REGIONS]);
        carried.is_some()
    });
    drop(contact);
    let fit = Fit {
        bodies,
        foundation: law,
        targets: &targets,
    };
    let table = fit.table(modulus_mpa);
    let increments = increments(&fit, &table);
    (table, increments)
}

/// Returns the errors of a table in the increments that it was fitted to.
fn increments(fit: &Fit<'_>, table: &PressureTable) -> Vec<FittedIncrement> {
    let near = vec![[0.0; MAX_REGIONS]; fit.targets.len()];
    let carried = fit.carried(table, &near);
    let law = Foundation {
        pressure: PressureLaw::TabulatedStrain(table.clone()),
        ..fit.foundation.clone()
    };
    let mut contact = law.contact(fit.bodies, ContactMemory::default());
    let pairs = fit.targets.iter().zip(carried);
    let increments = pairs.filter_map(|(target, carried)| {
        let carried = carried?;
        let force_n = target.force_at_same_pose_n(contact.as_mut());
        Some(FittedIncrement {
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
    increments.collect()
}

/// Errors of a number over the increments of stance, %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct StanceErrors {
    /// Root mean square.
    mean_percent: f64,
    /// The largest, without its sign.
    most_percent: f64,
    /// Of the highest value of the cycle, with its sign.
    of_highest_percent: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct CycleErrors {
    peak_pressure: StanceErrors,
    contact_area: StanceErrors,
}

/// Errors of a run of the foundation, relative to the deformable insert.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct RunErrors {
    first_cycle: CycleErrors,
    last_cycle: CycleErrors,
    /// Root mean square over the first cycle of the difference of each freedom, by its column.
    first_cycle_motions: BTreeMap<&'static str, f64>,
    deformable_mass_loss_mg: f64,
    mass_loss_mg: f64,
    mass_loss_percent: f64,
    deformable_max_depth_mm: f64,
    max_depth_mm: f64,
    max_depth_percent: f64,
    deformable_wall_s: f64,
    wall_s: f64,
}

impl RunErrors {
    fn between(foundation: &Ran, deformable: &Ran) -> Self {
        let (found, wanted) = (&foundation.summary, &deformable.summary);
        let [first, last] = first_and_last(&foundation.march);
        let [wanted_first, wanted_last] = first_and_last(&deformable.march);
        Self {
            first_cycle: CycleErrors::between(first, wanted_first),
            last_cycle: CycleErrors::between(last, wanted_last),
            first_cycle_motions: motions(&foundation.march, first, wanted_first),
            deformable_mass_loss_mg: wanted[&MASS_LOSS_MG],
            mass_loss_mg: found[&MASS_LOSS_MG],
            mass_loss_percent: error_percent(found[&MASS_LOSS_MG], wanted[&MASS_LOSS_MG]),
            deformable_max_depth_mm: wanted[&MAX_DEPTH_MM],
            max_depth_mm: found[&MAX_DEPTH_MM],
            max_depth_percent: error_percent(found[&MAX_DEPTH_MM], wanted[&MAX_DEPTH_MM]),
            deformable_wall_s: wanted[&WALL_S],
            wall_s: found[&WALL_S],
        }
    }
}

impl CycleErrors {
    fn between(found: &[CycleRow], wanted: &[CycleRow]) -> Self {
        Self {
            peak_pressure: stance_errors(found, wanted, |row| row.peak_pressure_mpa),
            contact_area: stance_errors(found, wanted, |row| row.contact_area_mm2),
        }
    }
}

/// Returns the root mean square of the difference of two cycles along each freedom of the machine, by its column.
fn motions(march: &March, found: &[CycleRow], wanted: &[CycleRow]) -> BTreeMap<&'static str, f64> {
    let machine = march.test().machine();
    let is_free = |joint: &JointIndex| matches!(machine.joint(*joint).drive, Drive::Loaded(_));
    let difference = |joint: JointIndex| {
        let description = machine.mechanism.joint(joint);
        let pairs = found.iter().zip(wanted);
        let squares = pairs
            .map(|(one, other)| joint.of(&one.positions) - joint.of(&other.positions))
            .map(|off| description.kind().in_files(off).powi(2));
        let mean = squares.sum::<f64>() / wanted.len() as f64;
        (description.column, mean.sqrt())
    };
    JointIndex::ALL
        .into_iter()
        .filter(is_free)
        .map(difference)
        .collect()
}

fn first_and_last(march: &March) -> [&[CycleRow]; 2] {
    let cycles = march.state().activities[0].first_and_last.as_ref();
    let (first, last) = cycles.expect("a finished march has solved cycles");
    [&first.rows, &last.rows]
}

fn stance_errors(
    found: &[CycleRow],
    wanted: &[CycleRow],
    value: fn(&CycleRow) -> f64,
) -> StanceErrors {
    let highest =
        |rows: &[CycleRow], value: fn(&CycleRow) -> f64| rows.iter().map(value).fold(0.0, f64::max);
    let highest_n = highest(wanted, |row| row.axial_force_n);
    let pairs = found.iter().zip(wanted);
    let stance = pairs.filter(|(_, wanted)| wanted.axial_force_n >= STANCE * highest_n);
    let off: Vec<f64> = stance
        .map(|(found, wanted)| error_percent(value(found), value(wanted)))
        .collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    StanceErrors {
        mean_percent: (squares / off.len() as f64).sqrt(),
        most_percent: off.iter().fold(0.0, |most, off| off.abs().max(most)),
        of_highest_percent: error_percent(highest(found, value), highest(wanted, value)),
    }
}

fn error_percent(found: f64, wanted: f64) -> f64 {
    100.0 * (found / wanted - 1.0)
}

impl CalibratedLaw {
    /// Returns the table as a CSV file for `[contact.foundation] strain_table_file`.
    pub fn to_csv(&self) -> String {
        match self.case.contact.law() {
            Some(PressureLawChoice::TabulatedStrain(table)) => table.to_csv(),
            _ => String::new(),
        }
    }

    /// Returns a page in Markdown: the errors of a run, by increment, and on other cases, and the table.
    pub fn markdown(&self) -> String {
        let mut page = format!(
            "# Calibrated pressure law\n\nWith this table the peak pressure in stance differs by up to {} % from that \
             of the deformable insert, in the first and the last cycle.\n\n",
            self.peak_error_percent
        );
        page += "Differences from the deformable insert, with the previous law and with the table. In stance the axial \
                 force is at least a fifth of its maximum:\n\n";
        page += &self.table_of_left();
        if !self.held_out.is_empty() {
            page += "\nCases outside the fit, with their own law and with the table:\n";
        }
        for held_out in &self.held_out {
            let case = held_out.case.display();
            let table = table_of_errors(&held_out.left_before, &held_out.left);
            page += &format!("\n`{case}`\n\n{table}");
        }
        page += "\nIncrements of the fit, on the unworn insert, under the forces of the deformable insert:\n\n";
        let head = "% of cycle|axial force, N|peak, MPa: deformable|table|area, mm2: deformable|table|\
                    force at the same approach, N|deeper by, mm";
        let mut rows = vec![head.split('|').map(str::to_owned).collect()];
        rows.extend(self.increments.iter().map(|increment| {
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
        }));
        page += &aligned(&rows);
        page += "\nThe table:\n\n";
        let head = ["overclosure over thickness", "pressure, MPa"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let points = self.table.iter();
        rows.extend(points.map(|(d, p)| vec![format!("{d:.6}"), format!("{p:.3}")]));
        page + &aligned(&rows)
    }

    /// Returns the errors of a run with the law before and with the table, in Markdown.
    pub fn table_of_left(&self) -> String {
        table_of_errors(&self.left_before, &self.left)
    }
}

fn table_of_errors(before: &RunErrors, after: &RunErrors) -> String {
    let mut rows = vec![["", "law before", "table"].map(str::to_owned).to_vec()];
    for ((name, before), (_, after)) in in_words(before).into_iter().zip(in_words(after)) {
        rows.push(vec![name, before, after]);
    }
    aligned(&rows)
}

fn in_words(errors: &RunErrors) -> Vec<(String, String)> {
    let in_stance = |off: StanceErrors| {
        let (mean, most, highest) = (off.mean_percent, off.most_percent, off.of_highest_percent);
        format!("{mean:.1} % (largest {most:.1} %, at the peak {highest:+.1} %)")
    };
    let (first, last) = (&errors.first_cycle, &errors.last_cycle);
    let [pressure, last_pressure, area, last_area] = [
        first.peak_pressure,
        last.peak_pressure,
        first.contact_area,
        last.contact_area,
    ]
    .map(in_stance);
    let mass = format!(
        "{:+.2} % ({:.2} mg, {:.2} on the deformable insert)",
        errors.mass_loss_percent, errors.mass_loss_mg, errors.deformable_mass_loss_mg
    );
    let depth = format!(
        "{:+.2} % ({:.4} mm, {:.4} on the deformable insert)",
        errors.max_depth_percent, errors.max_depth_mm, errors.deformable_max_depth_mm
    );
    let (wall_s, deformable_s) = (errors.wall_s, errors.deformable_wall_s);
    let time = format!("{wall_s:.2} s ({deformable_s:.2} s on the deformable insert)");
    let named = |(name, words): (&str, String)| (name.to_owned(), words);
    let contact = [
        ("peak pressure in stance, first cycle", pressure),
        ("the same, last cycle", last_pressure),
        ("contact area in stance, first cycle", area),
        ("the same, last cycle", last_area),
    ];
    let motions = errors.first_cycle_motions.iter();
    let motions =
        motions.map(|(column, rms)| (format!("{column}, first cycle"), format!("{rms:.3}")));
    let wear = [("mass lost", mass), ("deepest wear", depth), ("time", time)];
    let contact = contact.into_iter().map(named);
    contact
        .chain(motions)
        .chain(wear.into_iter().map(named))
        .collect()
}
