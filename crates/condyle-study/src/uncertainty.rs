//! The scatter of a test whose inputs vary from laboratory to laboratory and from specimen to specimen.

use std::{collections::BTreeMap, ops::ControlFlow, path::Path};

use condyle::{evolve::March, geometry::TriangleMesh, parameter::unit_of};
use condyle_case::{
    cache::Cache,
    case::Case,
    config::Level,
    study::{Design, Input, SampleKeys, ScaledKey, Study, TruncatedKeys, Variation},
};
use condyle_lab::{
    InMemory, Outcome, RunError, RunKeeper, aligned, measured::student,
    run_in_memory as run_with_error,
};
use condyle_results::{
    LawWear, Summary,
    catalogue::{self, Scalar},
};
use serde::Serialize;

use crate::{
    answers::tables::table,
    engine::{Listener, TestBench, run_in_memory},
    error::StudyError,
    plan::{Plan, TestResult},
    statistics::{central_interval, correlation, extent, mean, standard_deviation},
};

/// Largest deviation from the mean, in standard deviations: parts and set-ups beyond it are rejected.
const MAX_DEVIATIONS: f64 = 3.0;

/// All inputs that scatter. Columns: the name; the cases that have it: the joint, `any`, `by-joints` for machines by joints, or
/// `activities` for knee simulators with several; the keys, which move together and of which a case may have some; one standard
/// deviation as a part of the value or as a step in the unit of the key; its source. The source of a deviation that was not
/// measured states the assumption.
const SCATTERS: &str = include_str!("scatters.csv");

/// An input that scatters from test to test.
struct Scatter {
    name: &'static str,
    cases: &'static str,
    keys: Vec<&'static str>,
    is_part: bool,
    deviation: f64,
    source: &'static str,
}

fn scatters() -> impl Iterator<Item = Scatter> {
    records(SCATTERS).map(|[name, cases, keys, by, deviation, source]| Scatter {
        name,
        cases,
        keys: keys.split(' ').collect(),
        is_part: by == "part",
        deviation: deviation.parse().expect("a number"),
        source,
    })
}

/// Returns the records of a table that the crate includes, without its head.
pub(crate) fn records<const N: usize>(
    table: &'static str,
) -> impl Iterator<Item = [&'static str; N]> {
    table.lines().skip(1).map(|line| {
        let fields: Result<[&str; N], _> = line.split(';').collect::<Vec<_>>().try_into();
        fields.expect("a field for each column")
    })
}

impl Scatter {
    fn is_of(&self, case: &Case) -> bool {
        let is_by_joints = case.machine.rig.is_some();
        self.cases.split(' ').any(|word| match word {
            "any" => true,
            "by-joints" => is_by_joints,
            "moved-joints" => case.has_motion_curve(),
            // The waveforms of activities have no keys of their own.
            "activities" => !is_by_joints && !case.activities.is_empty(),
            joint => joint == case.tested_joint().name(),
        })
    }

    /// One standard deviation in words, such as `2 %` or `0.5 mm`.
    fn deviation(&self) -> String {
        if self.is_part {
            // Rounded to a tenth of a percent: products of decimal numbers have rounding errors.
            return format!("{} %", (1e3 * self.deviation).round() / 10.0);
        }
        let unit = unit_of(self.keys[0]).unwrap_or_default();
        format!("{} {unit}", self.deviation)
    }

    /// Returns the input of a study with values in standard deviations; its keys are empty if the
    /// case has none of them.
    fn input(&self, case: &Case) -> Input {
        let variation = Variation::TruncatedNormal(TruncatedKeys {
            mean: Some(0.0),
            standard_deviation: 1.0,
            low: -MAX_DEVIATIONS,
            high: MAX_DEVIATIONS,
        });
        let scaled = self.keys.iter().filter_map(|&key| {
            let mean = case.number_at_or_written(key)?;
            // A part of a value of 0 is no scatter: such a key is omitted.
            let scale = if self.is_part { mean } else { 1.0 };
            let standard_deviation = scale * self.deviation;
            (standard_deviation != 0.0).then_some(ScaledKey {
                key,
                mean,
                standard_deviation,
            })
        });
        let mut input = Input::new(self.name, variation);
        input.scaled = Some(scaled.collect());
        input
    }
}

/// The uncertainty of the results of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Uncertainty {
    runs: usize,
    /// The number of runs that do not pass a plausibility check.
    doubtful: usize,
    /// The reasons of those that failed.
    not_run: Vec<String>,
    seed: u64,
    inputs: Vec<Share>,
    /// The 95th percentile of the part of the variance of an input without influence.
    variance_percent_by_chance: f64,
    /// Inputs for which the case has no key.
    left_out: Vec<&'static str>,
    numbers: BTreeMap<&'static str, Spread>,
}

/// An input that scatters, and its part of the variance.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Share {
    name: &'static str,
    /// One standard deviation, with its unit.
    standard_deviation: String,
    source: &'static str,
    /// 100 times the square of the correlation with each result; 0 for fewer than three tests.
    variance_percent: BTreeMap<&'static str, f64>,
}

/// The scatter of a result, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Spread {
    /// The result of the case without changes.
    value: f64,
    /// Its discretisation error; none if the case does not request it.
    discretisation: Option<f64>,
    mean: f64,
    standard_deviation: f64,
    /// The 2.5th percentile.
    low: f64,
    /// The 97.5th percentile.
    high: f64,
    /// The smallest and the largest wear of all wear laws on the histories of the case.
    laws: Option<[f64; 2]>,
}

/// Returns the results that sensitivity and uncertainty studies report, of those that the runs have: a hip has no AP range.
pub(crate) fn compared(has: impl Fn(&Scalar) -> bool) -> impl Iterator<Item = &'static Scalar> {
    const KEYS: [&str; 5] = [
        "mass_loss_mg",
        "max_depth_mm",
        "peak_pressure_mpa",
        "ap_range_mm",
        "ie_range_deg",
    ];
    let all = KEYS.into_iter().filter_map(catalogue::scalar);
    all.filter(move |output| has(output))
}

/// Runs the case at `case_path` without changes, with its estimate of the error, and again in `size` tests, at least 2, with
/// scattered inputs: a Latin hypercube of independent normal distributions, truncated at three standard deviations. Nothing
/// is written, and results do not depend on the number of threads.
///
/// # Errors
/// A case that cannot be run without changes. A test with scattered inputs that fails is counted among the results.
pub fn uncertainty(
    case_path: &Path,
    size: u64,
    seed: u64,
    threads: usize,
    listener: &mut Listener<'_>,
) -> Result<Uncertainty, StudyError> {
    let sample = Design::LatinHypercube(SampleKeys { size, seed });
    let mut study = Study::of_case(case_path, sample)?;
    let as_given = with_error(&study.case)?;
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for scatter in scatters().filter(|scatter| scatter.is_of(&study.case)) {
        let input = scatter.input(&study.case);
        // A key with a value may still belong to another machine, shape or law than the case's, which refuses any other value.
        let is_refused = |deviations: &f64| {
            let set = input.assignments(Path::new(""), &Level::Number(*deviations));
            set.is_empty() || study.changed_case(&set).is_err()
        };
        if [-1.0, 1.0].iter().all(is_refused) {
            left_out.push(scatter.name);
        } else {
            study.inputs.push(input);
            kept.push(scatter);
        }
    }
    let plan = Plan::of(study)?;
    let found = run_in_memory(&plan, &TestBench::default(), threads, listener)?;
    let done = found.iter().filter(|found| found.is_ok()).count();
    let failed = found.iter().find_map(|found| found.as_ref().err());
    if let Some(reason) = failed.filter(|_| done < 2) {
        let problem = format!(
            "{done} of {size} runs with scattered inputs could be solved, too few for a scatter; the first failure: {reason}"
        );
        return Err(StudyError::Plan(problem));
    }
    Ok(Uncertainty::new(
        &plan, &as_given, &kept, left_out, seed, &found,
    ))
}

/// Returns the summary of a case, with its error estimate if the case requests one.
fn with_error(case: &Case) -> Result<Summary, RunError> {
    struct KeepNothing;
    impl RunKeeper for KeepNothing {
        fn settled(&mut self, _: &March, _: &TriangleMesh) {}
        fn updated(&mut self, _: &March) {}
    }
    let how = InMemory {
        threads: 1,
        cache: Cache::of_user(),
        wear_law: None,
    };
    let go_on = &mut |_: condyle_lab::RunEvent<'_>| ControlFlow::Continue(());
    match run_with_error(case, &how, &mut KeepNothing, go_on)? {
        Outcome::Done(summary) | Outcome::DoneBefore(summary) => Ok(*summary),
        Outcome::Interrupted(_) => unreachable!("the listener never stops it"),
    }
}

impl Uncertainty {
    fn new(
        plan: &Plan,
        as_given: &Summary,
        scatters: &[Scatter],
        left_out: Vec<&'static str>,
        seed: u64,
        found: &[TestResult],
    ) -> Self {
        let done = || {
            let rows = (0..plan.tests()).filter_map(|row| plan.test(row));
            let rows = rows.zip(found);
            rows.filter_map(|(test, found)| Some((test, found.as_ref().ok()?)))
        };
        let column = |output: &Scalar| -> Vec<f64> {
            done()
                .map(|(_, outputs)| plan.study().outputs.value(&outputs.values, output))
                .collect()
        };
        let compared = || compared(|output| as_given.get(output).is_some());
        let share = |(place, scatter): (usize, &Scatter)| {
            let deviations = done().map(|(test, _)| match test.values[place] {
                Some(Level::Number(deviations)) => deviations,
                _ => f64::NAN,
            });
            let deviations: Vec<f64> = deviations.collect();
            let percent = |output: &'static Scalar| {
                let correlation = correlation(&deviations, &column(output));
                (output.key, 100.0 * correlation.unwrap_or_default().powi(2))
            };
            Share {
                name: scatter.name,
                standard_deviation: scatter.deviation(),
                source: scatter.source,
                variance_percent: compared().map(percent).collect(),
            }
        };
        let spread = |output: &'static Scalar| {
            let values = column(output);
            (output.key, Spread::new(output, as_given, values))
        };
        Self {
            runs: done().count(),
            doubtful: done()
                .filter(|(_, outputs)| !outputs.doubts.is_empty())
                .count(),
            not_run: found
                .iter()
                .filter_map(|found| found.clone().err())
                .collect(),
            seed,
            inputs: scatters.iter().enumerate().map(share).collect(),
            variance_percent_by_chance: variance_percent_by_chance(done().count()),
            left_out,
            numbers: compared().map(spread).collect(),
        }
    }

    /// Tables in Markdown: the results, and the inputs that they depend on.
    pub fn markdown(&self) -> String {
        let head = [
            "number",
            "value",
            "discretisation",
            "inputs, 1 SD",
            "95 % of runs",
            "wear laws",
        ];
        let results = compared(|output| self.numbers.contains_key(output.key));
        let results: Vec<&Scalar> = results.collect();
        let numbers = table(&head, &results, |output| {
            let spread = &self.numbers[output.key];
            let shown = |value: f64| output.text(value);
            let range = |[low, high]: [f64; 2]| format!("{} to {}", shown(low), shown(high));
            let plus_minus = |value: f64| format!("+/- {}", shown(value));
            let dash = || "-".to_owned();
            vec![
                output.title(),
                shown(spread.value),
                spread.discretisation.map_or_else(dash, plus_minus),
                plus_minus(spread.standard_deviation),
                range([spread.low, spread.high]),
                spread.laws.map_or_else(dash, range),
            ]
        });
        let mut inputs: Vec<&Share> = self.inputs.iter().collect();
        let of_mass = |input: &Share| input.variance_percent["mass_loss_mg"];
        inputs.sort_by(|one, other| of_mass(other).total_cmp(&of_mass(one)));
        let head = [
            "input",
            "1 SD",
            "of mass variance",
            "of depth variance",
            "from",
        ];
        let inputs = table(&head, &inputs, |input| {
            let percent = |name| format!("{:.0} %", input.variance_percent[name]);
            vec![
                input.name.to_owned(),
                input.standard_deviation.clone(),
                percent("mass_loss_mg"),
                percent("max_depth_mm"),
                input.source.to_owned(),
            ]
        });
        format!(
            "{}\n{}\n{}",
            aligned(&numbers),
            self.notes(),
            aligned(&inputs)
        )
    }

    fn notes(&self) -> String {
        // The standard deviation of a sample of size n has a relative standard error of 1 / sqrt(2 (n - 1)).
        let known = 100.0 / (2.0 * (self.runs as f64 - 1.0).max(1.0)).sqrt();
        let mut text = format!(
            "{} runs, seed {}: standard deviations are known to {known:.0} %.\n",
            self.runs, self.seed
        );
        text += &format!(
            "An input without effect has up to {:.0} % of a variance by chance (95th percentile).\n",
            self.variance_percent_by_chance
        );
        if self.doubtful > 0 {
            text += &format!(
                "Doubtful runs: {}; `condyle run` states the reasons.\n",
                self.doubtful
            );
        }
        if let Some(reason) = self.not_run.first() {
            let count = self.not_run.len();
            text += &format!(
                "Not among them: {count} that could not be run, the first because of: {reason}\n"
            );
        }
        if !self.left_out.is_empty() {
            text += &format!(
                "Not varied, since no key of the case sets them: {}.\n",
                self.left_out.join(", ")
            );
        }
        text
    }
}

/// Returns the 95th percentile of 100 times the squared correlation of two independent normal samples:
/// r sqrt((n - 2) / (1 - r^2)) has Student's distribution of n - 2 degrees of freedom.
fn variance_percent_by_chance(runs: usize) -> f64 {
    let freedom = runs.saturating_sub(2);
    let square = student(0.95, freedom).map(|quantile| quantile * quantile);
    // Two points lie on a line.
    square.map_or(100.0, |square| 100.0 * square / (square + freedom as f64))
}

impl Spread {
    fn new(output: &Scalar, as_given: &Summary, values: Vec<f64>) -> Self {
        let error = as_given.error.as_ref();
        let laws = |of: fn(&LawWear) -> f64| {
            let laws = as_given.wear_laws.iter().map(of);
            (!as_given.wear_laws.is_empty()).then(|| extent(laws))
        };
        let laws = match output.key {
            "mass_loss_mg" => laws(|law| law.mass_loss_mg),
            "max_depth_mm" => laws(|law| law.max_depth_mm),
            _ => None,
        };
        let (mean, standard_deviation) = (mean(&values), standard_deviation(&values));
        let [low, high] = central_interval(values);
        Self {
            value: as_given[output],
            discretisation: error.and_then(|error| Some(error.get(output)?.in_unit.total)),
            mean,
            standard_deviation,
            low,
            high,
            laws,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(name: &str, text: &str, deviations: f64) -> Vec<String> {
        let case = Case::parse(text, "case", Path::new("")).unwrap();
        let scatter = scatters().find(|scatter| scatter.name == name);
        let input = scatter.unwrap().input(&case);
        let level = Level::Number(deviations);
        let set = input.assignments(Path::new(""), &level).into_iter();
        set.map(|set| set.to_string()).collect()
    }

    #[test]
    fn all_keys_of_a_scatter_move_together() {
        let set = set("stiffness of springs", "", 2.0);
        assert_eq!(set.len(), 2, "{set:?}");
        assert!(set[0].contains("37.18"), "{set:?}");
        let deviation = |name: &str| {
            let scatter = scatters().find(|scatter| scatter.name == name);
            scatter.unwrap().deviation()
        };
        assert_eq!(deviation("stiffness of springs"), "5 %");
        assert_eq!(deviation("wear factor"), "5.4 %");
        assert_eq!(deviation("thickness"), "0.05 mm");
    }

    #[test]
    fn the_factor_of_cross_linking_scatters_where_the_insert_is_cross_linked() {
        let off = |text: &str| set("cross-linked over conventional", text, -1.0);
        assert!(off("").is_empty());
        let [one] = &off("[material]\ncross_linking = \"high\"\n")[..] else {
            panic!("one key");
        };
        assert!(one.contains("0.168"), "{one}");
    }

    #[test]
    fn verify_what_an_input_without_effect_explains_by_chance() {
        // Limits of the correlation at 5 %, two-sided (Fisher and Yates 1938).
        for (runs, limit) in [(5, 0.8783), (10, 0.6319), (102, 0.1946)] {
            let part = variance_percent_by_chance(runs) / 100.0;
            assert!((part.sqrt() - limit).abs() < 1e-4, "{runs}: {part}");
        }
        assert_eq!(variance_percent_by_chance(2), 100.0);
    }

    #[test]
    fn what_is_nothing_has_no_part_of_itself() {
        assert!(set("friction", "[contact]\nfriction = 0.0\n", 1.0).is_empty());
    }
}
