//! The constants of a wear law that reproduce the wear of weighed specimens, with their intervals.

mod fit;

use std::path::{Path, PathBuf};

use condyle::wear::Archard;
use condyle_case::{
    cache::Cache,
    case::{Case, SharedBodies, Wear},
};
use serde::Serialize;

use crate::{
    measured::{
        calibrate::fit::{Fit, Free, fit, in_words},
        compare,
        error::{CalibrateError, CompareError},
        gravimetric::{GravimetricComparison, Interval},
    },
    run::running::march_watched,
};

/// Constants of a wear law found from weighings.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// Word of the law.
    pub law: &'static str,
    /// Confidence of every interval, percent.
    pub confidence_percent: f64,
    /// The constants found.
    pub constants: Vec<CalibratedConstant>,
    /// The amount of wear relative to the first run; none if single constants were found.
    pub times_as_much: Option<Estimate>,
    /// The tests.
    pub tests: Vec<CalibratedTest>,
    /// Scatter of a specimen around the prediction, percent of the rate; none if weighings are counted, or without
    /// degrees of freedom.
    pub scatter_percent: Option<f64>,
    /// Observations less parameters.
    pub degrees_of_freedom: usize,
    /// The reason for missing intervals.
    pub without_interval: Option<&'static str>,
    /// Cases predicted with these constants.
    pub predictions: Vec<Prediction>,
    #[serde(flatten)]
    one_test: Option<OneTest>,
    #[serde(flatten)]
    wear_factor: Option<WearFactor>,
    /// All constants that were run; the first are those of the first results folder.
    trials: Vec<Trial>,
}

/// A value and its interval.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// The interval; none without degrees of freedom.
    pub interval: Option<Interval>,
}

/// A constant that was found.
#[derive(Clone, Debug, Serialize)]
pub struct CalibratedConstant {
    /// Name and unit.
    pub name: &'static str,
    /// The value of the first run.
    pub run_with: f64,
    /// The value found.
    #[serde(flatten)]
    pub found: Estimate,
}

/// A test from which the constants were found.
#[derive(Clone, Debug, Serialize)]
pub struct CalibratedTest {
    /// The results folder.
    pub results: PathBuf,
    /// The measured data.
    pub measured: PathBuf,
    /// Description of the measured rate.
    pub measured_by: String,
    /// The measured rate.
    pub measured_mg_per_million_cycles: f64,
    /// Its own interval.
    pub interval_mg_per_million_cycles: Option<Interval>,
    /// The rate with the constants found.
    pub fitted_mg_per_million_cycles: f64,
    /// Fitted over measured, less one, percent.
    pub fitted_above_measured_percent: f64,
    /// Doubts about the run, and remarks on the measured data.
    pub remarks: Vec<String>,
}

/// A case predicted with the constants found.
#[derive(Clone, Debug, Serialize)]
pub struct Prediction {
    /// The case file.
    pub case: PathBuf,
    /// Cycles of the case.
    pub cycles: f64,
    /// Mass lost, mg.
    pub mass_loss_mg: f64,
    /// Interval of the mean of such specimens, not of one specimen.
    pub interval_mg: Option<Interval>,
}

/// The measured rate, at the top of the results of a calibration by one test.
#[derive(Clone, Debug, Serialize)]
struct OneTest {
    measured_mg_per_million_cycles: f64,
    measured_by: String,
    interval_mg_per_million_cycles: Option<Interval>,
}

/// The factor of Archard's law, at the top of the results.
#[derive(Clone, Debug, Serialize)]
struct WearFactor {
    run_with_mm3_per_nm: f64,
    wear_factor_mm3_per_nm: f64,
    wear_factor_interval_mm3_per_nm: Option<Interval>,
}

/// Finds the constants of a wear law that reproduce the weighings, by running the cases of results folders again; `tried`
/// receives every run.
///
/// `paths` alternate between results folders and files of measured data. `names` are those of the constants to find; if
/// there are none, the amount of wear is found, whatever the cycle. The cases `predicted` are run with the result.
///
/// More wear conforms the surfaces and so changes the wear that follows, so that rates are only nearly in proportion to
/// how much a law wears: least squares by iteration, until a step changes no rate by more than 0.1 %.
///
/// # Errors
/// No weighings, no wear, tests that do not determine the constants, or a run that fails.
pub fn calibrate(
    paths: &[PathBuf],
    names: &[String],
    predicted: &[PathBuf],
    tried: &mut dyn FnMut(&Trial),
) -> Result<Calibration, CalibrateError> {
    let tests = read(paths)?;
    let free = Free::new(tests[0].case.wear.clone(), names)?;
    for test in &tests {
        test.check()?;
    }
    let cases = predicted.iter().map(|path| Case::read(path));
    let cases: Vec<Case> = cases.collect::<Result<_, _>>()?;
    let mut trials = Vec::new();
    let mut model = |at: &[f64]| {
        let law = free.law(at)?;
        let rates = tests.iter().map(|test| test.rate(&law));
        let trial = Trial {
            constants: law.constants().to_vec(),
            mg_per_million_cycles: rates.collect::<Result<_, _>>()?,
        };
        tried(&trial);
        trials.push(trial.clone());
        Ok(trial.mg_per_million_cycles)
    };
    let observations: Vec<_> = tests
        .iter()
        .map(|test| test.weighed.observation())
        .collect();
    let confidence = tests[0].weighed.confidence_percent / 100.0;
    let fit = fit(&mut model, free.start(), &observations, confidence)?;
    let each = predicted.iter().zip(&cases);
    let predictions = each.map(|(path, case)| predict(path, case, &free, &fit));
    let predictions = predictions.collect::<Result<_, _>>()?;
    Ok(results(&tests, &free, &fit, predictions, trials))
}

fn read(paths: &[PathBuf]) -> Result<Vec<Test>, CalibrateError> {
    let pairs = paths.chunks_exact(2);
    if paths.is_empty() || !pairs.remainder().is_empty() {
        let given = paths.len();
        return Err(CalibrateError::Unsuitable(format!(
            "give a results folder and a file of measured data for each test: {given} paths do not form pairs"
        )));
    }
    let tests = pairs.map(|pair| Test::read(&pair[0], &pair[1]));
    let tests: Vec<Test> = tests.collect::<Result<_, _>>()?;
    let first = &tests[0];
    for test in &tests {
        let [law, own] = [test, first].map(|test| test.case.wear.kind().word);
        if law != own {
            return Err(CalibrateError::Unsuitable(format!(
                "{}: this run has the wear law \"{law}\", and the first one has \"{own}\"; run all with one law (--set \
                 wear.law={own})",
                test.results.display()
            )));
        }
        if !test.weighed.has_intervals_like(&first.weighed) {
            return Err(CalibrateError::Unsuitable(format!(
                "{}: [gravimetric] interval and confidence_percent are not those of the first test; tests that are fitted \
                 together need one kind of interval",
                test.measured.display()
            )));
        }
    }
    Ok(tests)
}

fn predict(path: &Path, case: &Case, free: &Free, fit: &Fit) -> Result<Prediction, CalibrateError> {
    let lost = |at: &[f64]| -> Result<(f64, f64), CalibrateError> {
        let losses = losses(case, &free.law(at)?)?;
        Ok(losses.last().copied().unwrap_or_default())
    };
    let (cycles, mass_loss_mg) = lost(&fit.at)?;
    let mut interval_mg = None;
    if let Some(spread) = &fit.spread {
        let mut slopes = Vec::new();
        for (number, half) in spread.half.iter().enumerate() {
            let mass_mg_at = |by: f64| {
                let mut at = fit.at.clone();
                at[number] += by;
                lost(&at).map(|(_, mass_mg)| mass_mg)
            };
            slopes.push((mass_mg_at(*half)? - mass_mg_at(-half)?) / (2.0 * half));
        }
        let half = spread.half_interval(&slopes);
        interval_mg = Some(not_below_zero(Interval::around(mass_loss_mg, half)));
    }
    Ok(Prediction {
        case: path.to_owned(),
        cycles,
        mass_loss_mg,
        interval_mg,
    })
}

/// Raises the ends of an interval to zero, since wear is never negative.
fn not_below_zero(interval: Interval) -> Interval {
    Interval {
        low: interval.low.max(0.0),
        ..interval
    }
}

fn results(
    tests: &[Test],
    free: &Free,
    fit: &Fit,
    predictions: Vec<Prediction>,
    trials: Vec<Trial>,
) -> Calibration {
    let constants = constants(free, fit);
    let spread = fit.spread.as_ref();
    let of_test = |(test, &rate): (&Test, &f64)| {
        let aim = test.weighed.aim();
        CalibratedTest {
            results: test.results.clone(),
            measured: test.measured.clone(),
            measured_by: aim.name.clone(),
            measured_mg_per_million_cycles: aim.mg_per_million_cycles,
            interval_mg_per_million_cycles: aim.interval_mg_per_million_cycles,
            fitted_mg_per_million_cycles: rate,
            fitted_above_measured_percent: 100.0 * (rate / aim.mg_per_million_cycles - 1.0),
            remarks: test.remarks.clone(),
        }
    };
    let calibrated: Vec<CalibratedTest> = tests.iter().zip(&fit.rates).map(of_test).collect();
    let factor = constants
        .iter()
        .find(|one| one.name == Archard::WEAR_FACTOR.name);
    Calibration {
        law: free.law.kind().word,
        confidence_percent: tests[0].weighed.confidence_percent,
        times_as_much: free.is_level().then(|| Estimate {
            value: fit.at[0],
            interval: interval_of(fit, 0).map(not_below_zero),
        }),
        scatter_percent: spread
            .filter(|_| tests[0].weighed.counts_specimens())
            .map(|spread| 100.0 * spread.scatter),
        degrees_of_freedom: spread.map_or(0, |spread| spread.freedom),
        without_interval: spread.is_none().then_some(
            "as many constants were found as there are measured rates, and no rate has a known scatter; weigh more \
             specimens, or more often",
        ),
        predictions,
        one_test: match &calibrated[..] {
            [test] => Some(OneTest {
                measured_mg_per_million_cycles: test.measured_mg_per_million_cycles,
                measured_by: test.measured_by.clone(),
                interval_mg_per_million_cycles: test.interval_mg_per_million_cycles,
            }),
            _ => None,
        },
        tests: calibrated,
        wear_factor: factor.map(|factor| WearFactor {
            run_with_mm3_per_nm: factor.run_with,
            wear_factor_mm3_per_nm: factor.found.value,
            wear_factor_interval_mm3_per_nm: factor.found.interval,
        }),
        constants,
        trials,
    }
}

fn interval_of(fit: &Fit, number: usize) -> Option<Interval> {
    let spread = fit.spread.as_ref()?;
    let slopes: Vec<f64> = (0..fit.at.len())
        .map(|own| f64::from(u8::from(own == number)))
        .collect();
    Some(Interval::around(
        fit.at[number],
        spread.half_interval(&slopes),
    ))
}

/// Returns every constant that changed, with its interval.
fn constants(free: &Free, fit: &Fit) -> Vec<CalibratedConstant> {
    let values = free.constants_near(&fit.at);
    let parameters = free.law.kind().parameters.iter().enumerate();
    let changed = parameters.filter(|(place, _)| free.changes(*place));
    let constant = |(place, parameter): (usize, &condyle::parameter::Parameter)| {
        let number = free.parameter_of(place);
        let at_end = |end: f64| {
            let mut at = fit.at.clone();
            at[number] = end;
            free.constants_near(&at)[place]
        };
        let interval = interval_of(fit, number).map(|ends| {
            let [one, other] = [at_end(ends.low), at_end(ends.high)];
            Interval {
                low: one.min(other),
                high: one.max(other),
            }
        });
        CalibratedConstant {
            name: parameter.name,
            run_with: free.law.constants()[place],
            found: Estimate {
                value: values[place],
                interval,
            },
        }
    };
    changed.map(constant).collect()
}

/// A run, and the weighings that it should reproduce.
pub(crate) struct Test {
    pub(crate) results: PathBuf,
    pub(crate) measured: PathBuf,
    pub(crate) case: Case,
    pub(crate) weighed: GravimetricComparison,
    remarks: Vec<String>,
}

/// Constants, and the rates of the tests with them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// The constants of the law, in its order.
    pub constants: Vec<f64>,
    /// Predicted rate of each test, by the same regression as the measured one.
    pub mg_per_million_cycles: Vec<f64>,
}

impl Test {
    pub(crate) fn read(results: &Path, measured: &Path) -> Result<Self, CalibrateError> {
        let comparison = compare(results, measured)?;
        Ok(Self {
            weighed: comparison.gravimetric.ok_or_else(|| {
                let problem =
                    "the measured data have no [gravimetric] table, which the calibration of a wear law needs";
                CalibrateError::Unsuitable(problem.to_owned())
            })?,
            remarks: comparison.remarks,
            case: Case::read(&results.join("case.toml"))?,
            results: results.to_owned(),
            measured: measured.to_owned(),
        })
    }

    /// Rejects specimens or runs without wear.
    pub(crate) fn check(&self) -> Result<(), CalibrateError> {
        let mg_per_million_cycles = self.weighed.aim().mg_per_million_cycles;
        if mg_per_million_cycles <= 0.0 || !mg_per_million_cycles.is_finite() {
            return Err(CalibrateError::Unsuitable(format!(
                "the measured wear rate is {mg_per_million_cycles:.3} mg per million cycles: no constants \
                 reproduce it; check the masses and the soak controls"
            )));
        }
        if self.weighed.predicted.mg_per_million_cycles <= 0.0 {
            return Err(CalibrateError::Unsuitable(format!(
                "{}: the run wears nothing with {}, so its wear cannot be scaled; if that is a wear factor of 0, give it one \
                 above 0, and run it again",
                self.results.display(),
                in_words(&self.case.wear)
            )));
        }
        Ok(())
    }

    /// Returns the rate with another law, run in memory; if the law is the same, the rate of the folder.
    pub(crate) fn rate(&self, law: &Wear) -> Result<f64, CalibrateError> {
        if *law == self.case.wear {
            return Ok(self.weighed.predicted.mg_per_million_cycles);
        }
        let rate = self.weighed.rate_of(&losses(&self.case, law)?);
        Ok(rate.ok_or_else(|| CompareError::run_too_short(0))?)
    }
}

/// Mass lost after each update of a case with another law, as (cycles, mg), from zero at the start.
pub(crate) fn losses(case: &Case, law: &Wear) -> Result<Vec<(f64, f64)>, CalibrateError> {
    let mut case = case.clone();
    case.wear = law.clone();
    let (cache, bodies) = (Cache::off(), SharedBodies::default());
    let marched = march_watched(&case, &cache, &bodies, &mut |_| ());
    let (run, _) = marched.map_err(|source| CalibrateError::Run {
        constants: in_words(law),
        source: Box::new(source),
    })?;
    let updates = run.march.state().updates.iter();
    let losses = updates.map(|update| (update.cycles, update.mass_loss_mg));
    Ok(std::iter::once((0.0, 0.0)).chain(losses).collect())
}
