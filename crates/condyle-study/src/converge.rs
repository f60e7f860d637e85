//! Convergence: a case run over finer and finer values of one of its numbers.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use condyle_case::{
    cache::Cache,
    case::{Assignment, Case},
    config::{Level, Levels},
    study::{Design, FactorialKeys, Input, LevelKeys, Study, Variation},
};
use condyle_lab::{Outcome, RunError, RunEvent, RunOptions, aligned, run_case};
use condyle_report::{Plot, plots_svg, study::with_powers};
use condyle_results::{
    Summary,
    catalogue::{self, Scalar},
    json_text, replace_file,
};
use serde_json::json;

use crate::{
    engine::{Listener, Reporter, StudyEvent, run_all},
    error::StudyError,
    observed_order::{Extrapolation, extrapolate},
    plan::{Plan, Test},
    store::holds_anything,
};

/// Options of a convergence study.
#[derive(Clone, Debug)]
pub struct ConvergeOptions {
    /// Folder for the study; every run gets a folder in it, such as `updates-10`.
    pub out: PathBuf,
    /// Runs at the same time; results do not depend on it.
    pub threads: usize,
    /// Resumes the study in the folder instead of starting it.
    pub resume: bool,
    /// Cache of the one-time work on a mesh; results do not depend on it.
    pub cache: Cache,
}

/// One run of a convergence study.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The value of the number.
    pub value: f64,
    /// Name of the run's folder in the folder of the study.
    pub folder: String,
    /// The results of the run.
    pub summary: Summary,
}

/// The runs of a convergence study.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// Dotted path of the number.
    pub key: String,
    /// The runs from coarse to fine, two or more.
    pub points: Vec<Point>,
    /// The step of each run: the error is proportional to a power of it.
    pub steps: Vec<f64>,
}

fn compared() -> impl Iterator<Item = &'static Scalar> {
    const KEYS: [&str; 5] = [
        "mass_loss_mg",
        "volume_loss_mm3",
        "max_depth_mm",
        "peak_pressure_mpa",
        "peak_contact_area_mm2",
    ];
    KEYS.into_iter().filter_map(catalogue::scalar)
}

/// Runs the case at `case_path` over values written as `key=value,value,...`, each into its own folder, and writes
/// `converge.csv`, `converge.json` and `converge.svg` next to them.
///
/// The key is a dotted path, such as `march.updates`, or the last word of one, with or without its unit. A count is finer
/// where it is larger, any other number where it is smaller.
///
/// # Errors
/// Every problem of the input that is detected before it runs; a folder that cannot be used; the coarsest run that
/// failed; [`StudyError::Interrupted`] if the listener breaks, after which the study can be resumed.
pub fn converge(
    case_path: &Path,
    over: &str,
    options: &ConvergeOptions,
    listener: &mut Listener<'_>,
) -> Result<Convergence, StudyError> {
    let (plan, values) = plan(case_path, over)?;
    let input = &plan.study().inputs[0];
    let mut cases = Vec::new();
    for test in (0..plan.tests()).filter_map(|row| plan.test(row)) {
        let mut case = plan.case_of(&test)?;
        // The study itself shows the errors that each run would otherwise estimate.
        case.accuracy.estimate = false;
        cases.push(case);
    }
    if !options.resume && holds_anything(&options.out)? {
        let problem = "the folder is not empty; give another one with --out, or resume its study with --resume";
        return Err(StudyError::folder(&options.out, problem));
    }
    let points = run_points(&plan, &values, &cases, options, listener)?;
    let step = |value: &f64| if input.is_whole { 1.0 / value } else { *value };
    let convergence = Convergence {
        key: input.key.clone(),
        steps: values.iter().map(step).collect(),
        points,
    };
    for (name, text) in [
        ("converge.csv", convergence.csv()),
        ("converge.json", convergence.json()),
        ("converge.svg", convergence.svg()),
    ] {
        let path = options.out.join(name);
        replace_file(&path, text.as_bytes()).map_err(StudyError::refused(&path))?;
    }
    Ok(convergence)
}

/// Runs the case of every test, and returns the points from coarse to fine.
fn run_points(
    plan: &Plan,
    values: &[f64],
    cases: &[Case],
    options: &ConvergeOptions,
    listener: &mut Listener<'_>,
) -> Result<Vec<Point>, StudyError> {
    let key = &plan.study().inputs[0].key;
    let work = |test: &Test, reporter: &Reporter<'_, Ran>| {
        let row = test.row as usize;
        let value = values[row];
        let ran = run(&cases[row], &folder_name(key, value), options, reporter);
        if let Ok(Some(summary)) = &ran {
            let mass = summary[&catalogue::MASS_LOSS_MG];
            let depth = summary[&catalogue::MAX_DEPTH_MM];
            let message = format!("{key} = {value}: {mass:.3} mg worn, {depth:.4} mm deep");
            let _ = reporter.report(StudyEvent::Message(message));
        }
        ran
    };
    let mut points = Vec::new();
    for (&value, ran) in values
        .iter()
        .zip(run_all(plan, options.threads, &work, listener)?)
    {
        let ran = ran.map_err(|source| StudyError::RunWith {
            number: format!("{key} = {value}"),
            source: Box::new(source),
        })?;
        points.push(Point {
            value,
            folder: folder_name(key, value),
            summary: *ran.ok_or(StudyError::Interrupted)?,
        });
    }
    Ok(points)
}

/// Returns the plan with one test for each value, and the values from coarse to fine.
fn plan(case_path: &Path, over: &str) -> Result<(Plan, Vec<f64>), StudyError> {
    let no_key = || {
        let problem =
            format!("`{over}` is not a key with values; write them as `updates=1,2,5,10`");
        StudyError::Plan(problem)
    };
    let (key, written) = over.split_once('=').ok_or_else(no_key)?;
    let key = key.trim();
    if key.is_empty() {
        return Err(no_key());
    }
    let written = written.split(',').map(str::trim);
    let written: Vec<&str> = written.filter(|value| !value.is_empty()).collect();
    if written.len() < 2 {
        let found = ["no value", "one value"][written.len()];
        return Err(StudyError::Plan(format!(
            "`{key}` has {found} where two or more are needed to compare; write them as `{key}=10,20,40`"
        )));
    }
    // A factorial design of one input is one test for each of its levels.
    let mut study = Study::of_case(
        case_path,
        Design::FullFactorial(FactorialKeys { points: 2 }),
    )?;
    let path = study.case.path_of_number(key)?;
    let is_whole = study.case.is_whole_number(&path);
    let values = written.into_iter().map(|text| {
        let number = Assignment::number(&path, text)?;
        Ok(number.as_number().unwrap_or_default())
    });
    let mut values: Vec<f64> = values.collect::<Result<_, StudyError>>()?;
    values.sort_by(|one, other| {
        let by_size = one.total_cmp(other);
        if is_whole { by_size } else { by_size.reverse() }
    });
    if let Some(pair) = values.windows(2).find(|pair| pair[0] == pair[1]) {
        let value = pair[0];
        return Err(StudyError::Plan(format!(
            "`{key}` has the value {value} twice; write each once"
        )));
    }
    // Levels are tests in their order: row and value have the same number.
    let levels = Levels(values.iter().copied().map(Level::Number).collect());
    let mut input = Input::new(&path, Variation::Levels(LevelKeys { levels }));
    input.is_whole = is_whole;
    study.inputs = vec![input];
    Ok((Plan::of(study)?, values))
}

/// Returns the folder name of a run: the last word of the key and the value, such as `updates-10`.
fn folder_name(key: &str, value: f64) -> String {
    format!("{}-{value}", last_word(key))
}

fn last_word(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

/// A summary, or none if the run was interrupted.
type Ran = Result<Option<Box<Summary>>, RunError>;

fn run(case: &Case, folder: &str, options: &ConvergeOptions, reporter: &Reporter<'_, Ran>) -> Ran {
    let out = options.out.join(folder);
    let options = RunOptions {
        resume: options.resume && out.join("case.toml").exists(),
        out,
        force: false,
        threads: 1,
        cache: options.cache.clone(),
        report: true,
    };
    let mut on_event = |event: RunEvent<'_>| {
        reporter.report(match event {
            RunEvent::Warning(warning) => StudyEvent::Message(format!("warning: {warning}")),
            _ => StudyEvent::Working,
        })
    };
    match run_case(case, &options, &mut on_event)? {
        Outcome::Done(summary) | Outcome::DoneBefore(summary) => Ok(Some(summary)),
        Outcome::Interrupted(_) => Ok(None),
    }
}

impl Convergence {
    fn values(&self, output: &Scalar) -> Vec<f64> {
        let points = self.points.iter();
        points.map(|point| point.summary[output]).collect()
    }

    /// Differences of a result from that of the finest run, % of it.
    fn differences_percent(&self, output: &Scalar) -> Vec<f64> {
        let values = self.values(output);
        let finest = values.last().copied().unwrap_or(f64::NAN);
        let difference = |value: &f64| 100.0 * (value / finest - 1.0);
        values.iter().map(difference).collect()
    }

    fn extrapolation(&self, output: &Scalar) -> Extrapolation {
        extrapolate(&self.steps, &self.values(output))
    }

    /// Returns a row for each run, from coarse to fine.
    fn csv(&self) -> String {
        let keys: Vec<&str> = compared().map(|output| output.key).collect();
        let differences: Vec<String> = compared()
            .map(|output| format!("{}_difference_percent", output.stem()))
            .collect();
        let (keys, differences) = (keys.join(","), differences.join(","));
        let mut text = format!("{},{keys},cycles_solved,{differences}\n", self.key);
        let columns = |of: fn(&Self, &Scalar) -> Vec<f64>, row: usize| {
            let cells: Vec<String> = compared()
                .map(|output| of(self, output)[row].to_string())
                .collect();
            cells.join(",")
        };
        for (row, point) in self.points.iter().enumerate() {
            let values = columns(Self::values, row);
            let differences = columns(Self::differences_percent, row);
            let (value, solved) = (point.value, point.summary[&catalogue::CYCLES_SOLVED]);
            text += &format!("{value},{values},{solved},{differences}\n");
        }
        text
    }

    fn json(&self) -> String {
        let by_key = |of: fn(&Self, &Scalar) -> Vec<f64>, row: usize| -> BTreeMap<_, f64> {
            let values = compared().map(|output| (output.key, of(self, output)[row]));
            values.collect()
        };
        let run = |(row, point): (usize, &Point)| {
            let mut run = json!({
                "value": point.value,
                "folder": point.folder,
                "cycles_solved": point.summary[&catalogue::CYCLES_SOLVED],
                "differences_percent": by_key(Self::differences_percent, row),
                "inputs_blake3": point.summary.inputs_blake3,
            });
            for (key, value) in by_key(Self::values, row) {
                run[key] = value.into();
            }
            run
        };
        let limits = compared().map(|output| (output.key, self.extrapolation(output)));
        let file = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "key": self.key,
            "finest": self.points.last().map(|point| point.value),
            "runs": self.points.iter().enumerate().map(run).collect::<Vec<_>>(),
            "extrapolations": limits.collect::<BTreeMap<_, _>>(),
        });
        json_text(&file)
    }

    fn svg(&self) -> String {
        // Mass is volume times a constant: one plot for both.
        let shown = compared().filter(|output| output.key != "volume_loss_mm3");
        let plots: Vec<Plot> = shown.map(|output| self.plot(output)).collect();
        let line = format!("a run for each value of {}", self.key);
        plots_svg("Convergence", &plots, 2, &["extrapolated", "", &line])
    }

    fn plot(&self, output: &Scalar) -> Plot {
        /// The smallest span of an axis, as a share of the finest value: smaller differences are not visible.
        const MIN_SHOWN_SHARE: f64 = 1e-3;
        // Finer runs lie to the right, by the logarithm of their steps where they have one.
        let has_logarithms = self.steps.iter().all(|step| *step > 0.0);
        let place = |(number, step): (usize, &f64)| {
            if has_logarithms {
                -step.ln()
            } else {
                number as f64
            }
        };
        let places: Vec<f64> = self.steps.iter().enumerate().map(place).collect();
        let line: Vec<(f64, f64)> = places.iter().copied().zip(self.values(output)).collect();
        let finest = line.last().map_or(0.0, |point| point.1);
        let ends = [places[0], places[places.len() - 1]];
        let values = self.points.iter().map(|point| point.value.to_string());
        Plot {
            title: output.label[..1].to_uppercase() + &output.label[1..],
            unit: with_powers(output.unit()),
            x_marks: places.iter().copied().zip(values).collect(),
            // A result of 0 has no share; the axis still needs a length.
            min_span: MIN_SHOWN_SHARE * finest.abs().max(f64::MIN_POSITIVE),
            reference: match self.extrapolation(output) {
                Extrapolation::Converging { extrapolated, .. } => {
                    ends.map(|place| (place, extrapolated)).to_vec()
                }
                _ => Vec::new(),
            },
            line,
            ..Plot::default()
        }
    }

    /// Tables in Markdown: results, differences from the finest run, and limits.
    pub fn markdown(&self) -> String {
        let key = last_word(&self.key);
        let results: Vec<&Scalar> = compared().collect();
        let titles: Vec<String> = results.iter().map(|output| output.title()).collect();
        let head = |first: &str, last: Option<&str>| {
            let titles = titles.iter().map(String::as_str);
            let head = std::iter::once(first).chain(titles).chain(last);
            head.map(str::to_owned).collect::<Vec<_>>()
        };
        let values: Vec<Vec<f64>> = results.iter().map(|output| self.values(output)).collect();
        let differences = results
            .iter()
            .map(|output| self.differences_percent(output));
        let differences: Vec<Vec<f64>> = differences.collect();
        let limits: Vec<[String; 3]> = results
            .iter()
            .map(|output| in_words(self.extrapolation(output)))
            .collect();
        let mut runs = vec![head(key, Some("cycles solved"))];
        let finest = self.points.last().map_or(f64::NAN, |point| point.value);
        let from_finest = format!("difference from {key} = {finest}, %");
        let mut off = vec![head(&from_finest, None)];
        for (row, point) in self.points.iter().enumerate() {
            let first = [point.value.to_string()];
            let cells = values.iter().map(|values| significant(values[row]));
            let solved = format!("{:.1}", point.summary[&catalogue::CYCLES_SOLVED]);
            runs.push(first.iter().cloned().chain(cells).chain([solved]).collect());
            let cells = differences.iter().map(|values| percent(values[row]));
            off.push(first.iter().cloned().chain(cells).collect());
        }
        let mut tendency = vec![head("as the steps go to zero", None)];
        let names = ["order", "extrapolated", "finest from it, %"];
        for (row, name) in names.map(str::to_owned).into_iter().enumerate() {
            let cells = limits.iter().map(|limit| limit[row].clone());
            tendency.push([name].into_iter().chain(cells).collect());
        }
        let mut text = [runs, off, tendency].map(|rows| aligned(&rows)).join("\n");
        for point in &self.points {
            let doubts = point.summary.doubts();
            if !doubts.is_empty() {
                text += &format!(
                    "\n{key} = {} is doubtful: {}.\n",
                    point.value,
                    doubts.join(", ")
                );
            }
        }
        text
    }
}

/// Order, limit and error of the finest run.
fn in_words(extrapolation: Extrapolation) -> [String; 3] {
    let alone = |word: &str| [word.to_owned(), String::new(), String::new()];
    match extrapolation {
        Extrapolation::Converging {
            order,
            extrapolated,
            finest_error_percent,
        } => [
            format!("{order:.2}"),
            significant(extrapolated),
            percent(finest_error_percent),
        ],
        Extrapolation::Slow { order } => {
            [format!("{order:.2}"), "too slow".to_owned(), String::new()]
        }
        Extrapolation::Unchanged => alone("unchanged"),
        Extrapolation::Oscillating => alone("oscillates"),
        Extrapolation::Diverging => alone("diverges"),
        Extrapolation::NoConstantRatio => alone("-"),
    }
}

fn percent(value: f64) -> String {
    format!("{value:+.3}")
}

/// Returns a number with five significant digits.
fn significant(value: f64) -> String {
    let magnitude = match value {
        0.0 => 0,
        _ => value.abs().log10().floor() as i32,
    };
    let decimals = (4 - magnitude).max(0) as usize;
    format!("{value:.decimals$}")
}
