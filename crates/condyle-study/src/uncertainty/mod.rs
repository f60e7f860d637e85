//! How far a test would scatter whose inputs are never quite the same.

pub(crate) mod scatter;

use condyle_results::catalogue;
use std::{collections::BTreeMap, ops::ControlFlow, path::Path};

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_case::{
    cache::Cache,
    case::{Assignment, Case, SharedBodies},
};
use condyle_lab::{InMemory, Outcome, RunError, RunKeeper, aligned, batch_run, run_in_memory};
use condyle_results::{ErrorEstimate, LawWear, Summary};
use serde::Serialize;

use crate::{
    chance::latin_hypercube,
    engine::{first_line, in_parallel},
    uncertainty::scatter::{Scatter, deviations, scatters},
};

/// How an uncertainty is found.
#[derive(Clone, Copy, Debug)]
pub struct UncertaintyOptions {
    /// Runs with other inputs; at least 2.
    pub runs: usize,
    /// Of the chance by which inputs are chosen.
    pub seed: u64,
    /// Runs at the same time; results do not depend on it.
    pub threads: usize,
}

/// Runs the case at `case_path` as it is, with its estimate of the error, and again with inputs that scatter:
/// friction, loads, springs, placement, thickness, modulus and wear factor, as far as the case has them. The inputs
/// are a Latin hypercube of normal distributions cut off at three standard deviations, and know nothing of each
/// other. Nothing is written.
///
/// `tell` hears of every run with other inputs that is done, from any thread.
///
/// # Errors
/// A case that cannot be run as it is. A run with other inputs that fails is counted among the results.
pub fn uncertainty(
    case_path: &Path,
    options: UncertaintyOptions,
    tell: &(dyn Fn() + Sync),
) -> Result<Uncertainty, RunError> {
    let case = Case::read(case_path)?;
    let as_given = with_error(&case)?;
    let (scatters, left_out): (Vec<_>, Vec<_>) =
        scatters().partition(|scatter| takes(case_path, &case, scatter));
    let points = drawn(options, scatters.len());
    let bodies = SharedBodies::default();
    let ran = in_parallel(points.len(), options.threads, |index| {
        let set = off_by(&case, &scatters, &points[index]);
        let found = ran_with(case_path, &set, &bodies).map_err(|error| first_line(&error));
        tell();
        found
    });
    let inputs = scatters.iter().map(|scatter| Input::of(scatter)).collect();
    let mut found = Uncertainty::of(&as_given, inputs, &points, &ran);
    found.seed = options.seed;
    found.left_out = left_out.iter().map(|scatter| scatter.name).collect();
    Ok(found)
}

/// Whether a case has keys of a scatter: it takes them as they are.
fn takes(case_path: &Path, case: &Case, scatter: &Scatter) -> bool {
    let set = scatter.off_by(case, 0.0);
    !set.is_empty() && Case::read_changed(case_path, &set).is_ok()
}

/// For each run, by how many standard deviations each input is off.
fn drawn(options: UncertaintyOptions, inputs: usize) -> Vec<Vec<f64>> {
    let mut points = latin_hypercube(options.runs, inputs, options.seed);
    let values = points.iter_mut().flatten();
    values.for_each(|share| *share = deviations(*share));
    points
}

/// What inputs that are off by so many standard deviations set.
fn off_by(case: &Case, scatters: &[&Scatter], point: &[f64]) -> Vec<Assignment> {
    let inputs = scatters.iter().zip(point);
    inputs
        .flat_map(|(scatter, deviations)| scatter.off_by(case, *deviations))
        .collect()
}

/// A run with other values.
fn ran_with(
    case_path: &Path,
    set: &[Assignment],
    bodies: &SharedBodies,
) -> Result<Summary, RunError> {
    let other = Case::read_changed(case_path, set)?;
    batch_run(&other, &Cache::of_user(), bodies)
}

/// The summary of a case, with its estimate of the error if it asks for one.
fn with_error(case: &Case) -> Result<Summary, RunError> {
    let how = InMemory {
        threads: 1,
        cache: Cache::of_user(),
        wear_law: None,
    };
    let outcome = run_in_memory(case, &how, &mut Nothing, &mut |_| ControlFlow::Continue(()))?;
    match outcome {
        Outcome::Done(summary) | Outcome::DoneBefore(summary) => Ok(*summary),
        Outcome::Interrupted(_) => unreachable!("nobody asks it to stop"),
    }
}

/// Keeps nothing of a run.
struct Nothing;

impl RunKeeper for Nothing {
    fn settled(&mut self, _: &March, _: &TriangleMesh) {}

    fn updated(&mut self, _: &March) {}
}

/// A number of a run, what is told of it, and how it is written.
struct Number {
    name: &'static str,
    title: &'static str,
    decimals: usize,
    of: fn(&Summary) -> f64,
    error: fn(&ErrorEstimate) -> f64,
    /// What a law of wear says of it.
    by_law: Option<fn(&LawWear) -> f64>,
}

const NUMBERS: [Number; 5] = [
    Number {
        name: "mass_loss_mg",
        title: "mass loss, mg",
        decimals: 2,
        of: |summary| summary[&catalogue::MASS_LOSS_MG],
        error: |error| error[&catalogue::MASS_LOSS_MG].in_unit.total,
        by_law: Some(|law| law.mass_loss_mg),
    },
    Number {
        name: "max_depth_mm",
        title: "deepest wear, mm",
        decimals: 4,
        of: |summary| summary[&catalogue::MAX_DEPTH_MM],
        error: |error| error[&catalogue::MAX_DEPTH_MM].in_unit.total,
        by_law: Some(|law| law.max_depth_mm),
    },
    Number {
        name: "peak_pressure_mpa",
        title: "peak pressure, MPa",
        decimals: 1,
        of: |summary| summary[&catalogue::PEAK_PRESSURE_MPA],
        error: |error| error[&catalogue::PEAK_PRESSURE_MPA].in_unit.total,
        by_law: None,
    },
    Number {
        name: "ap_range_mm",
        title: "AP range, mm",
        decimals: 2,
        of: |summary| summary[&catalogue::AP_RANGE_MM],
        error: |error| error[&catalogue::AP_RANGE_MM].in_unit.total,
        by_law: None,
    },
    Number {
        name: "ie_range_deg",
        title: "IE range, degrees",
        decimals: 2,
        of: |summary| summary[&catalogue::IE_RANGE_DEG],
        error: |error| error[&catalogue::IE_RANGE_DEG].in_unit.total,
        by_law: None,
    },
];

/// An input that scatters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Input {
    /// What it is.
    pub name: &'static str,
    /// One standard deviation, with its unit.
    pub standard_deviation: String,
    /// Where that is from.
    pub source: &'static str,
    /// What part of the variance of each number goes with it, %: 100 times the square of the correlation. Of a
    /// number that does not scatter, and of less than three runs, 0.
    pub variance_percent: BTreeMap<&'static str, f64>,
}

/// How a number scatters, in its own unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Of the case as it is.
    pub value: f64,
    /// Discretisation error of that; none where the case does not ask for it.
    pub discretisation: Option<f64>,
    /// Mean of the runs with other inputs.
    pub mean: f64,
    /// Their standard deviation.
    pub standard_deviation: f64,
    /// 2.5 % of them lie below.
    pub low: f64,
    /// 2.5 % of them lie above.
    pub high: f64,
    /// Least and most of all wear laws on the histories of the case as it is; of wear alone.
    pub laws: Option<[f64; 2]>,
}

/// The uncertainty of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Uncertainty {
    /// Runs with other inputs that came to their end.
    pub runs: usize,
    /// Why others did not.
    pub not_run: Vec<String>,
    /// Of the chance by which inputs were chosen.
    pub seed: u64,
    /// What scatters.
    pub inputs: Vec<Input>,
    /// What would scatter, but the case has no key for it.
    pub left_out: Vec<&'static str>,
    /// The numbers, by names with their units.
    pub numbers: BTreeMap<&'static str, Spread>,
}

impl Input {
    pub(crate) fn of(scatter: &Scatter) -> Self {
        Self {
            name: scatter.name,
            standard_deviation: scatter.deviation(),
            source: scatter.source,
            variance_percent: BTreeMap::new(),
        }
    }
}

impl Uncertainty {
    /// That of a case by what runs found whose inputs were off by so many standard deviations.
    pub(crate) fn of(
        as_given: &Summary,
        mut inputs: Vec<Input>,
        points: &[Vec<f64>],
        ran: &[Result<Summary, String>],
    ) -> Self {
        let failed = ran.iter().filter_map(|ran| ran.as_ref().err());
        let not_run = failed.map(|why| why.trim().to_owned()).collect();
        let done = || {
            points
                .iter()
                .zip(ran)
                .filter_map(|(point, ran)| Some((point, ran.as_ref().ok()?)))
        };
        let mut numbers = BTreeMap::new();
        for number in &NUMBERS {
            let values: Vec<f64> = done().map(|(_, summary)| (number.of)(summary)).collect();
            for (place, input) in inputs.iter_mut().enumerate() {
                let off: Vec<f64> = done().map(|(point, _)| point[place]).collect();
                let percent = 100.0 * correlation(&off, &values).powi(2);
                input.variance_percent.insert(number.name, percent);
            }
            numbers.insert(number.name, Spread::of(number, as_given, values));
        }
        Self {
            runs: done().count(),
            not_run,
            seed: 0,
            inputs,
            left_out: Vec::new(),
            numbers,
        }
    }

    /// Tables in Markdown: the numbers, and what they hang on.
    pub fn markdown(&self) -> String {
        format!(
            "{}\n{}\n{}",
            self.table_of_numbers(),
            self.notes(),
            self.table_of_inputs()
        )
    }

    fn table_of_numbers(&self) -> String {
        let head = [
            "number",
            "value",
            "discretisation",
            "inputs, 1 SD",
            "95 % of runs",
            "wear laws",
        ];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(NUMBERS.iter().map(|number| {
            let spread = &self.numbers[number.name];
            let shown = |value: f64| format!("{value:.*}", number.decimals);
            let range = |[low, high]: [f64; 2]| format!("{} to {}", shown(low), shown(high));
            let dash = || "-".to_owned();
            vec![
                number.title.to_owned(),
                shown(spread.value),
                spread
                    .discretisation
                    .map_or_else(dash, |error| format!("+/- {}", shown(error))),
                format!("+/- {}", shown(spread.standard_deviation)),
                range([spread.low, spread.high]),
                spread.laws.map_or_else(dash, range),
            ]
        }));
        aligned(&rows)
    }

    fn notes(&self) -> String {
        // The standard deviation of a sample of n scatters by 1 / sqrt(2 (n - 1)) of itself.
        let known = 100.0 / (2.0 * (self.runs as f64 - 1.0).max(1.0)).sqrt();
        let mut text = format!(
            "{} runs, seed {}: standard deviations are known to {known:.0} %.\n",
            self.runs, self.seed
        );
        if let Some(why) = self.not_run.first() {
            let count = self.not_run.len();
            text +=
                &format!("Not among them: {count} that could not be run, the first since: {why}\n");
        }
        if !self.left_out.is_empty() {
            text += &format!("This case has no key for: {}.\n", self.left_out.join(", "));
        }
        text
    }

    /// The inputs, what most of the mass hangs on first.
    fn table_of_inputs(&self) -> String {
        let head = [
            "input",
            "1 SD",
            "of mass variance",
            "of depth variance",
            "from",
        ];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let mut inputs: Vec<&Input> = self.inputs.iter().collect();
        let of_mass = |input: &Input| input.variance_percent["mass_loss_mg"];
        inputs.sort_by(|one, other| of_mass(other).total_cmp(&of_mass(one)));
        rows.extend(inputs.iter().map(|input| {
            let percent = |name| format!("{:.0} %", input.variance_percent[name]);
            vec![
                input.name.to_owned(),
                input.standard_deviation.clone(),
                percent("mass_loss_mg"),
                percent("max_depth_mm"),
                input.source.to_owned(),
            ]
        }));
        aligned(&rows)
    }
}

impl Spread {
    fn of(number: &Number, as_given: &Summary, mut values: Vec<f64>) -> Self {
        let mean = mean(&values);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let variance = squares / (values.len() as f64 - 1.0).max(1.0);
        values.sort_by(f64::total_cmp);
        let of_laws = |of: fn(&LawWear) -> f64| {
            let laws = || as_given.wear_laws.iter().map(of);
            [
                laws().fold(f64::INFINITY, f64::min),
                laws().fold(0.0, f64::max),
            ]
        };
        Self {
            value: (number.of)(as_given),
            discretisation: as_given.error.as_ref().map(number.error),
            mean,
            standard_deviation: variance.sqrt(),
            low: quantile(&values, 0.025),
            high: quantile(&values, 0.975),
            laws: number
                .by_law
                .filter(|_| !as_given.wear_laws.is_empty())
                .map(of_laws),
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / (values.len() as f64).max(1.0)
}

/// Below which lies this part of sorted values, straight between two of them; 0 of none.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return 0.0;
    };
    let place = part * last as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

/// Pearson's; 0 where either does not vary, and of less than three.
fn correlation(one: &[f64], other: &[f64]) -> f64 {
    let (mean_one, mean_other) = (mean(one), mean(other));
    let [mut both, mut own, mut others] = [0.0; 3];
    for (a, b) in one.iter().zip(other) {
        let (a, b) = (a - mean_one, b - mean_other);
        both += a * b;
        own += a * a;
        others += b * b;
    }
    if one.len() < 3 || own == 0.0 || others == 0.0 {
        return 0.0;
    }
    both / (own * others).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_quantiles_lie_between_values() {
        let sorted: Vec<f64> = (0..=40).map(f64::from).collect();
        assert_eq!(quantile(&sorted, 0.025), 1.0);
        assert_eq!(quantile(&sorted, 0.975), 39.0);
        assert_eq!(quantile(&[3.0, 5.0], 0.25), 3.5);
        assert_eq!(quantile(&[], 0.5), 0.0);
    }

    #[test]
    fn verify_correlations() {
        let x = [1.0, 2.0, 3.0, 4.0];
        assert!((correlation(&x, &[2.0, 4.0, 6.0, 8.0]) - 1.0).abs() < 1e-15);
        assert!((correlation(&x, &[1.0, -1.0, -1.0, 1.0])).abs() < 1e-15);
        assert_eq!(correlation(&x, &[5.0; 4]), 0.0);
        assert_eq!(correlation(&x[..2], &[1.0, 2.0]), 0.0);
    }
}
