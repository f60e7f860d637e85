//! A case run over finer and finer values of one of its numbers.

use condyle_results::catalogue;
use std::{
    collections::BTreeMap,
    fmt::Write,
    fs, io,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use condyle_case::{
    cache::Cache,
    case::{Assignment, AssignmentError, Case, ChangeError},
    config::Problems,
};
use condyle_lab::{Outcome, RunError, RunEvent, RunOptions, run_case};
use condyle_report::{Plot, plots_svg};
use condyle_results::Summary;
use serde::Serialize;
use thiserror::Error;

use crate::observed_order::{Extrapolation, extrapolate};

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
        of: |summary| summary[&catalogue::MASS_LOSS_MG],
    },
    Quantity {
        name: "volume_loss_mm3",
        title: "volume loss",
        unit: "mm3",
        of: |summary| summary[&catalogue::VOLUME_LOSS_MM3],
    },
    Quantity {
        name: "max_depth_mm",
        title: "deepest wear",
        unit: "mm",
        of: |summary| summary[&catalogue::MAX_DEPTH_MM],
    },
    Quantity {
        name: "peak_pressure_mpa",
        title: "peak pressure",
        unit: "MPa",
        of: |summary| summary[&catalogue::PEAK_PRESSURE_MPA],
    },
    Quantity {
        name: "peak_contact_area_mm2",
        title: "largest area",
        unit: "mm2",
        of: |summary| summary[&catalogue::PEAK_CONTACT_AREA_MM2],
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
                value: run.value,
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
    let path = run.number.key();
    let key = path.rsplit('.').next().unwrap_or(path);
    format!("{key}-{}", run.value)
}

/// Why a study of convergence is not done.
#[derive(Debug, Error)]
pub enum ConvergeError {
    /// The case file, as it is or with one of the values.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A key or a value that is none.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
    /// Not written as a key with values.
    #[error("`{written}` is no key with values; write them as `updates=1,2,5,10`")]
    NotKeyAndValues {
        /// As written.
        written: String,
    },
    /// Fewer than two values.
    #[error("`{key}` has {} where two or more are needed to compare; write them as `{key}=10,20,40`", if *found == 0 { "no value" } else { "one value" })]
    TooFew {
        /// The key as written.
        key: String,
        /// How many there are.
        found: usize,
    },
    /// A value that stands twice.
    #[error("`{key}` has the value {value} twice; write each once")]
    Twice {
        /// The key as written.
        key: String,
        /// The value.
        value: f64,
    },
    /// A folder that holds something.
    #[error("{}: the folder is not empty; give another one with --out, or go on with --resume", folder.display())]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
    },
    /// The system refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// One of the runs.
    #[error("{number}: {source}")]
    Run {
        /// The key and its value, such as `march.updates = 1`.
        number: String,
        /// Why.
        source: Box<RunError>,
    },
}

/// A case, once for each value of one of its numbers, from coarse to fine.
#[derive(Clone, Debug)]
pub struct ConvergePlan {
    pub(crate) path: String,
    pub(crate) is_whole: bool,
    pub(crate) runs: Vec<Planned>,
}

/// A case with one number changed.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The number.
    pub number: Assignment,
    /// Its value.
    pub value: f64,
    /// The case with it.
    pub case: Case,
}

impl ConvergePlan {
    /// The case at `case_path` over values written as `key=value,value,...`.
    ///
    /// The key is a dotted path, such as `march.updates`, or the last word of one, with or without
    /// its unit. A number that counts is finer where it is larger, any other where it is smaller.
    ///
    /// # Errors
    /// Everything that can be known of the input before it runs.
    pub fn new(case_path: &Path, written: &str) -> Result<Self, ConvergeError> {
        let (key, values) = key_and_values(written)?;
        let case = Case::read(case_path)?;
        let path = case.path_of_number(key)?;
        let mut runs = Vec::new();
        for text in values {
            let number = Assignment::number(&path, text)?;
            let value = number.as_number().unwrap_or_default();
            let changed = Case::read_changed(case_path, std::slice::from_ref(&number));
            let mut case = changed.map_err(|error| match error {
                ChangeError::Case(problems) => ConvergeError::from(problems),
                ChangeError::Assignment(error) => error.into(),
            })?;
            // The study itself shows what its runs would otherwise estimate one by one.
            case.accuracy.estimate = false;
            runs.push(Planned {
                number,
                value,
                case,
            });
        }
        let is_whole = runs[0].case.is_whole_number(&path);
        sort(&mut runs, is_whole);
        if let Some(twice) = twice(&runs) {
            let (key, value) = (key.to_owned(), twice);
            return Err(ConvergeError::Twice { key, value });
        }
        Ok(Self {
            path,
            is_whole,
            runs,
        })
    }

    /// Dotted path of the key.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The runs, from coarse to fine.
    pub fn runs(&self) -> &[Planned] {
        &self.runs
    }

    /// What the error goes with a power of: a value, or one over it where it counts.
    pub(crate) fn step(&self, value: f64) -> f64 {
        if self.is_whole { 1.0 / value } else { value }
    }
}

/// Whether `folder` may take a new study; nothing is made.
pub(crate) fn check_free(folder: &Path) -> Result<(), ConvergeError> {
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => {
            let path = folder.to_owned();
            return Err(ConvergeError::Refused { path, source });
        }
    };
    match entries.next() {
        None => Ok(()),
        Some(_) => Err(ConvergeError::NotEmpty {
            folder: folder.to_owned(),
        }),
    }
}

fn key_and_values(written: &str) -> Result<(&str, Vec<&str>), ConvergeError> {
    let no_key = || ConvergeError::NotKeyAndValues {
        written: written.to_owned(),
    };
    let (key, values) = written.split_once('=').ok_or_else(no_key)?;
    let key = key.trim();
    if key.is_empty() {
        return Err(no_key());
    }
    let mut values: Vec<&str> = values.split(',').map(str::trim).collect();
    values.retain(|value| !value.is_empty());
    if values.len() < 2 {
        let (key, found) = (key.to_owned(), values.len());
        return Err(ConvergeError::TooFew { key, found });
    }
    Ok((key, values))
}

fn sort(runs: &mut [Planned], is_whole: bool) {
    let value = |run: &Planned| run.value;
    runs.sort_by(|one, other| {
        if is_whole {
            value(one).total_cmp(&value(other))
        } else {
            value(other).total_cmp(&value(one))
        }
    });
}

fn twice(runs: &[Planned]) -> Option<f64> {
    let values = runs.windows(2);
    let mut same = values.filter(|pair| pair[0].value == pair[1].value);
    Some(same.next()?[0].value)
}

/// The least that a plot shows, as a share of the finest value: less is the same to a reader.
const MIN_SHOWN_SHARE: f64 = 1e-3;

impl Convergence {
    /// Writes the three files into `folder`.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), ConvergeError> {
        for (name, text) in [
            ("converge.csv", self.csv()),
            ("converge.json", self.json()),
            ("converge.svg", self.svg()),
        ] {
            let path = folder.join(name);
            fs::write(&path, text).map_err(|source| ConvergeError::Refused { path, source })?;
        }
        Ok(())
    }

    /// A row a run, from coarse to fine.
    fn csv(&self) -> String {
        let names = QUANTITIES.map(|quantity| quantity.name);
        let differences =
            QUANTITIES.map(|quantity| format!("{}_difference_percent", base(&quantity)));
        let mut text = format!(
            "{},{},cycles_solved,{}\n",
            self.key,
            names.join(","),
            differences.join(",")
        );
        let columns = QUANTITIES.map(|quantity| self.differences_percent(&quantity));
        for (row, point) in self.points.iter().enumerate() {
            let values = QUANTITIES.map(|quantity| (quantity.of)(&point.summary).to_string());
            let differences = columns.each_ref().map(|column| column[row].to_string());
            writeln!(
                text,
                "{},{},{},{}",
                point.value,
                values.join(","),
                point.summary[&catalogue::CYCLES_SOLVED],
                differences.join(",")
            )
            .expect("writing to a string cannot fail");
        }
        text
    }

    fn json(&self) -> String {
        let file = File {
            version: env!("CARGO_PKG_VERSION"),
            key: &self.key,
            finest: self.points.last().map_or(f64::NAN, |point| point.value),
            runs: (0..self.points.len()).map(|row| self.run(row)).collect(),
            extrapolations: QUANTITIES
                .iter()
                .map(|quantity| (quantity.name, self.extrapolation(quantity)))
                .collect(),
        };
        let mut text =
            serde_json::to_string_pretty(&file).expect("numbers and text always serialise");
        text.push('\n');
        text
    }

    fn run(&self, row: usize) -> Run<'_> {
        let point = &self.points[row];
        Run {
            value: point.value,
            folder: &point.folder,
            results: QUANTITIES
                .iter()
                .map(|quantity| (quantity.name, (quantity.of)(&point.summary)))
                .collect(),
            cycles_solved: point.summary[&catalogue::CYCLES_SOLVED],
            differences_percent: QUANTITIES
                .iter()
                .map(|quantity| (quantity.name, self.differences_percent(quantity)[row]))
                .collect(),
            inputs_blake3: &point.summary.inputs_blake3,
        }
    }

    fn svg(&self) -> String {
        // Mass is volume times a constant: one plot for both.
        let shown = QUANTITIES
            .iter()
            .filter(|quantity| quantity.name != "volume_loss_mm3");
        let plots: Vec<Plot> = shown.map(|quantity| self.plot(quantity)).collect();
        let line = format!("a run for each value of {}", self.key);
        plots_svg("Convergence", &plots, ["extrapolated", &line])
    }

    fn plot(&self, quantity: &Quantity) -> Plot {
        let places = self.places();
        let line: Vec<(f64, f64)> = places.iter().copied().zip(self.values(quantity)).collect();
        let finest = line.last().map_or(0.0, |point| point.1);
        let across = [places[0], places[places.len() - 1]];
        Plot {
            title: first_upper(quantity.title),
            unit: quantity.unit.replace('2', "\u{b2}").replace('3', "\u{b3}"),
            x_title: "",
            x_marks: places
                .iter()
                .zip(&self.points)
                .map(|(place, point)| (*place, mark(point)))
                .collect(),
            from_zero: false,
            least_span: MIN_SHOWN_SHARE * finest.abs().max(f64::MIN_POSITIVE),
            reference: match self.extrapolation(quantity) {
                Extrapolation::Converging { extrapolated, .. } => {
                    across.map(|place| (place, extrapolated)).to_vec()
                }
                _ => Vec::new(),
            },
            line,
        }
    }

    /// Where each run stands from left to right: finer to the right, by the logarithm of its step.
    fn places(&self) -> Vec<f64> {
        if self.steps.iter().all(|step| *step > 0.0) {
            self.steps.iter().map(|step| -step.ln()).collect()
        } else {
            (0..self.steps.len()).map(|place| place as f64).collect()
        }
    }
}

/// What `converge.json` holds.
#[derive(Serialize)]
struct File<'a> {
    version: &'static str,
    key: &'a str,
    finest: f64,
    runs: Vec<Run<'a>>,
    extrapolations: BTreeMap<&'static str, Extrapolation>,
}

/// One run of `converge.json`.
#[derive(Serialize)]
struct Run<'a> {
    value: f64,
    folder: &'a str,
    #[serde(flatten)]
    results: BTreeMap<&'static str, f64>,
    cycles_solved: f64,
    differences_percent: BTreeMap<&'static str, f64>,
    inputs_blake3: &'a str,
}

fn mark(point: &Point) -> String {
    point.value.to_string()
}

/// The name of a quantity without its unit.
fn base(quantity: &Quantity) -> &'static str {
    let unit = quantity.name.rfind('_').unwrap_or(quantity.name.len());
    &quantity.name[..unit]
}

fn first_upper(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}
