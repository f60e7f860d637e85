//! A case run over finer and finer values of one of its numbers.

use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use condyle_io::{cache::Cache, results::Summary};

use super::converge_plan::{ConvergeError, ConvergePlan, Planned, check_free};
use super::observed_order::{Extrapolation, extrapolate};
use crate::{Outcome, RunError, RunEvent, RunOptions, run_case};

/// How a study of convergence is run.
#[derive(Clone, Debug)]
pub struct ConvergeOptions {
    /// Folder for the study; every run gets a folder in it, such as `updates-10`.
    pub out: PathBuf,
    /// Runs at the same time; results do not depend on it.
    pub threads: usize,
    /// Go on with the study that is in the folder.
    pub resume: bool,
    /// Where the one-time work on a mesh is kept for the next run; results do not depend on it.
    pub cache: Cache,
}

/// What happens while a study runs.
#[derive(Clone, Debug)]
pub enum ConvergeHappening<'a> {
    /// In a run with this number.
    In(&'a Planned, RunEvent<'a>),
    /// A run is done.
    Ran(&'a Planned, &'a Summary),
}

/// Hears of everything, from any thread, and may stop the study by breaking.
pub type Listener<'a> = dyn Fn(&ConvergeHappening<'_>) -> ControlFlow<()> + Sync + 'a;

/// How a study ended.
#[derive(Clone, Debug)]
pub enum Converged {
    /// All runs are done.
    Done(Convergence),
    /// Somebody asked to stop; what was computed is kept, and can be gone on with.
    Interrupted,
}

/// One run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The number that was changed.
    pub value: f64,
    /// The same as written.
    pub text: String,
    /// Its run's folder, in that of the study.
    pub folder: String,
    /// What the run found.
    pub summary: Summary,
}

/// The runs of a study, and what they tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// Dotted path of the number that was changed.
    pub key: String,
    /// The runs, from coarse to fine: two or more.
    pub points: Vec<Point>,
    /// What the error goes with a power of, a value a run.
    pub steps: Vec<f64>,
}

/// A result of a run that is compared.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Its name in files, which ends in its unit.
    pub name: &'static str,
    /// Its name on the screen.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Where a summary has it.
    pub of: fn(&Summary) -> f64,
}

/// The results that are compared.
pub const QUANTITIES: [Quantity; 5] = [
    Quantity {
        name: "mass_loss_mg",
        title: "mass loss",
        unit: "mg",
        of: |summary| summary.mass_loss_mg,
    },
    Quantity {
        name: "volume_loss_mm3",
        title: "volume loss",
        unit: "mm3",
        of: |summary| summary.volume_loss_mm3,
    },
    Quantity {
        name: "max_depth_mm",
        title: "deepest wear",
        unit: "mm",
        of: |summary| summary.max_depth_mm,
    },
    Quantity {
        name: "peak_pressure_mpa",
        title: "peak pressure",
        unit: "MPa",
        of: |summary| summary.peak_pressure_mpa,
    },
    Quantity {
        name: "peak_contact_area_mm2",
        title: "largest area",
        unit: "mm2",
        of: |summary| summary.peak_contact_area_mm2,
    },
];

impl Convergence {
    /// A result of every run.
    pub fn values(&self, quantity: &Quantity) -> Vec<f64> {
        let of = |point: &Point| (quantity.of)(&point.summary);
        self.points.iter().map(of).collect()
    }

    /// How far a result of every run lies above that of the finest, % of it.
    pub fn differences_percent(&self, quantity: &Quantity) -> Vec<f64> {
        let values = self.values(quantity);
        let finest = values.last().copied().unwrap_or(f64::NAN);
        let difference = |value: &f64| 100.0 * (value / finest - 1.0);
        values.iter().map(difference).collect()
    }

    /// What a result tends to.
    pub fn extrapolation(&self, quantity: &Quantity) -> Extrapolation {
        extrapolate(&self.steps, &self.values(quantity))
    }
}

/// Runs every case of `plan` into a folder of its own, and writes what they tell into
/// `converge.csv`, `converge.json` and `converge.svg` beside them.
///
/// # Errors
/// A folder that cannot be used, or the error of the coarsest run that failed; the others are kept.
pub fn converge(
    plan: &ConvergePlan,
    options: &ConvergeOptions,
    listener: &Listener<'_>,
) -> Result<Converged, ConvergeError> {
    if !options.resume {
        check_free(&options.out)?;
    }
    let mut points = Vec::new();
    for (run, outcome) in plan.runs.iter().zip(run_all(plan, options, listener)) {
        match outcome {
            Ok(Some(summary)) => points.push(Point {
                value: run.number.value(),
                text: run.number.text().to_owned(),
                folder: folder_name(run),
                summary: *summary,
            }),
            Ok(None) => return Ok(Converged::Interrupted),
            Err(source) => {
                let number = format!("{} = {}", plan.path, run.number.text());
                let source = Box::new(source);
                return Err(ConvergeError::Run { number, source });
            }
        }
    }
    let convergence = Convergence {
        key: plan.path.clone(),
        steps: points.iter().map(|point| plan.step(point.value)).collect(),
        points,
    };
    convergence.write(&options.out)?;
    Ok(Converged::Done(convergence))
}

/// A summary, or nothing where somebody asked to stop.
type Ran = Result<Option<Box<Summary>>, RunError>;

/// Runs all cases, the finest first because it tends to take longest; results in the plan's order.
fn run_all(plan: &ConvergePlan, options: &ConvergeOptions, listener: &Listener<'_>) -> Vec<Ran> {
    let outcomes: Vec<Mutex<Ran>> = plan.runs.iter().map(|_| Mutex::new(Ok(None))).collect();
    let taken = AtomicUsize::new(0);
    let work = || {
        while let Some(left) = plan
            .runs
            .len()
            .checked_sub(1 + taken.fetch_add(1, Ordering::Relaxed))
        {
            let ran = run_one(&plan.runs[left], options, listener);
            let stop = matches!(ran, Ok(None));
            *outcomes[left].lock().expect("no thread panics with it") = ran;
            if stop {
                return;
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..options.threads.clamp(1, plan.runs.len()) {
            scope.spawn(work);
        }
    });
    let outcome = |ran: Mutex<Ran>| ran.into_inner().expect("no thread panics with it");
    outcomes.into_iter().map(outcome).collect()
}

fn run_one(run: &Planned, options: &ConvergeOptions, listener: &Listener<'_>) -> Ran {
    let out = options.out.join(folder_name(run));
    let resume = options.resume && holds_a_run(&out);
    let options = RunOptions {
        out,
        resume,
        force: false,
        threads: 1,
        cache: options.cache.clone(),
    };
    let mut tell = |what: RunEvent<'_>| listener(&ConvergeHappening::In(run, what));
    match run_case(&run.case, &options, &mut tell)? {
        Outcome::Done(summary) | Outcome::DoneBefore(summary) => {
            let _ = listener(&ConvergeHappening::Ran(run, &summary));
            Ok(Some(summary))
        }
        Outcome::Interrupted { .. } => Ok(None),
    }
}

fn holds_a_run(folder: &Path) -> bool {
    folder.join("case.toml").exists()
}

/// The last word of the key and the value, such as `updates-10`.
fn folder_name(run: &Planned) -> String {
    let path = run.number.path();
    let key = path.rsplit('.').next().unwrap_or(path);
    format!("{key}-{}", run.number.value())
}
