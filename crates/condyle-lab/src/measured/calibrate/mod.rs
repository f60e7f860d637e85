//! The wear factor with which the prediction wears as fast as the specimens did.

use std::ops::ControlFlow;
use std::path::Path;

use condyle::{
    evolve::{MarchError, Progress},
    parameter::Parameter,
    wear::Archard,
};
use condyle_io::{
    cache::Cache,
    case::{Case, ConstantError},
    keyed::Problems,
};
use serde::Serialize;
use thiserror::Error;

use super::{CompareError, GravimetricComparison, Interval, compare};
use crate::RunError;
use crate::run::{build, start};

/// The constant of the wear law that is found.
const FACTOR: Parameter = Archard::WEAR_FACTOR;
/// Rates that differ by less than this part of the measured one match.
const MATCHES: f64 = 1e-3;
/// Runs for one rate at most; nearly linear as it is, two or three are enough.
const MOST_RUNS: usize = 12;

/// Why no wear factor could be found.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The comparison with the weighings.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The case of the results folder.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A wear law without a wear factor, or a factor that no law may have.
    #[error("no wear factor can be found: {0}")]
    Factor(#[from] ConstantError),
    /// A run with another factor.
    #[error("with a wear factor of {factor_mm3_per_nm:.3e} mm3/(N m): {source}")]
    Run {
        /// The factor.
        factor_mm3_per_nm: f64,
        /// Why.
        source: Box<RunError>,
    },
    /// The physics with another factor.
    #[error("with a wear factor of {factor_mm3_per_nm:.3e} mm3/(N m): {source}")]
    March {
        /// The factor.
        factor_mm3_per_nm: f64,
        /// Why.
        source: MarchError,
    },
    /// Measured data without weighings.
    #[error("the measured data have no [gravimetric] table, which a wear factor is found from")]
    NotWeighed,
    /// Specimens that lost nothing.
    #[error(
        "the measured wear rate is {mg_per_million_cycles:.3} mg per million cycles: there is no \
         wear factor that makes a prediction of it; check the masses and the soak controls"
    )]
    NoWear {
        /// The rate.
        mg_per_million_cycles: f64,
    },
    /// A run that wears nothing.
    #[error(
        "the run wears nothing, so its wear factor of {factor_mm3_per_nm:.3e} mm3/(N m) cannot be \
         scaled; give it one above 0, and run it again"
    )]
    RunWithoutWear {
        /// The factor.
        factor_mm3_per_nm: f64,
    },
    /// A search that does not end.
    #[error(
        "after {runs} runs the wear rate is still {left_percent:.2} % off the measured one, with a \
         factor of {factor_mm3_per_nm:.3e} mm3/(N m); use more updates or increments in the case"
    )]
    NotFound {
        /// Runs made.
        runs: usize,
        /// What is left.
        left_percent: f64,
        /// The last factor.
        factor_mm3_per_nm: f64,
    },
}

impl CalibrateError {
    /// Whether the physics could not be solved, rather than the input being wrong.
    pub fn is_physics(&self) -> bool {
        match self {
            Self::March { .. } => true,
            Self::Run { source, .. } => source.is_physics(),
            _ => false,
        }
    }
}

/// A wear factor found from weighings.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// Measured rate that the prediction was made to match.
    pub measured_mg_per_million_cycles: f64,
    /// What that rate is.
    pub measured_by: String,
    /// Its interval; none where it is of one specimen alone.
    pub interval_mg_per_million_cycles: Option<Interval>,
    /// Confidence of the intervals, percent.
    pub confidence_percent: f64,
    /// Factor of the case that was run.
    pub run_with_mm3_per_nm: f64,
    /// Factor with which the prediction wears as fast as was measured.
    pub wear_factor_mm3_per_nm: f64,
    /// Factors at the ends of the interval of the measured rate.
    pub wear_factor_interval_mm3_per_nm: Option<Interval>,
    /// Every factor that was run, in this order; the first is that of the results folder.
    pub trials: Vec<Trial>,
}

/// A factor and the rate it gives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// Wear factor.
    pub wear_factor_mm3_per_nm: f64,
    /// Predicted rate by the same regression as the measured one.
    pub mg_per_million_cycles: f64,
}

/// Finds the wear factor for the weighings that `measured` names, by running the case in
/// `results` again; `tried` hears of every run.
///
/// More wear conforms the surfaces and so changes the wear that follows, so that the rate is only
/// nearly in proportion to the factor: from there, regula falsi until rates agree to 0.1 %.
///
/// # Errors
/// No weighings, no wear, or a run that fails.
pub fn calibrate(
    results: &Path,
    measured: &Path,
    tried: &mut dyn FnMut(&Trial),
) -> Result<Calibration, CalibrateError> {
    let comparison = compare(results, measured)?;
    let weighed = comparison.gravimetric.ok_or(CalibrateError::NotWeighed)?;
    let case = Case::read(&results.join("case.toml"))?;
    let mut search = Search::new(&case, &weighed, tried)?;
    let aim = weighed.aim();
    let factor = search.factor_for(aim.mg_per_million_cycles)?;
    let ends = aim.interval_mg_per_million_cycles;
    let interval = ends.map(|ends| search.factors_for(ends)).transpose()?;
    Ok(Calibration {
        measured_mg_per_million_cycles: aim.mg_per_million_cycles,
        measured_by: aim.name.clone(),
        interval_mg_per_million_cycles: ends,
        confidence_percent: weighed.confidence_percent,
        run_with_mm3_per_nm: case.wear.constant(FACTOR.name)?,
        wear_factor_mm3_per_nm: factor,
        wear_factor_interval_mm3_per_nm: interval,
        trials: search.trials,
    })
}

/// Runs made so far.
struct Search<'a> {
    case: &'a Case,
    weighed: &'a GravimetricComparison,
    tried: &'a mut dyn FnMut(&Trial),
    trials: Vec<Trial>,
}

impl<'a> Search<'a> {
    /// Starts from the run that is there.
    fn new(
        case: &'a Case,
        weighed: &'a GravimetricComparison,
        tried: &'a mut dyn FnMut(&Trial),
    ) -> Result<Self, CalibrateError> {
        let first = Trial {
            wear_factor_mm3_per_nm: case.wear.constant(FACTOR.name)?,
            mg_per_million_cycles: weighed.predicted.mg_per_million_cycles,
        };
        if first.wear_factor_mm3_per_nm <= 0.0 || first.mg_per_million_cycles <= 0.0 {
            return Err(CalibrateError::RunWithoutWear {
                factor_mm3_per_nm: first.wear_factor_mm3_per_nm,
            });
        }
        tried(&first);
        Ok(Self {
            case,
            weighed,
            tried,
            trials: vec![first],
        })
    }

    fn factors_for(&mut self, rates: Interval) -> Result<Interval, CalibrateError> {
        // A lower limit of no wear is a factor of 0.
        let low = if rates.low > 0.0 {
            self.factor_for(rates.low)?
        } else {
            0.0
        };
        let high = self.factor_for(rates.high)?;
        Ok(Interval { low, high })
    }

    /// The factor that gives a rate to within 0.1 %.
    fn factor_for(&mut self, rate: f64) -> Result<f64, CalibrateError> {
        if rate <= 0.0 || !rate.is_finite() {
            return Err(CalibrateError::NoWear {
                mg_per_million_cycles: rate,
            });
        }
        for _ in 0..MOST_RUNS {
            let nearest = self.nearest(rate);
            if off(&nearest, rate).abs() <= MATCHES {
                return Ok(nearest.wear_factor_mm3_per_nm);
            }
            let trial = self.run(guess(&self.trials, rate))?;
            (self.tried)(&trial);
            self.trials.push(trial);
        }
        let nearest = self.nearest(rate);
        Err(CalibrateError::NotFound {
            runs: MOST_RUNS,
            left_percent: 100.0 * off(&nearest, rate),
            factor_mm3_per_nm: nearest.wear_factor_mm3_per_nm,
        })
    }

    /// The trial whose rate is nearest.
    fn nearest(&self, rate: f64) -> Trial {
        let nearer = |a: Trial, b: &Trial| {
            if off(b, rate).abs() < off(&a, rate).abs() {
                *b
            } else {
                a
            }
        };
        self.trials.iter().fold(self.trials[0], nearer)
    }

    /// Runs the case with another factor, in memory.
    fn run(&self, factor_mm3_per_nm: f64) -> Result<Trial, CalibrateError> {
        let rate = self.weighed.rate_of(&self.losses(factor_mm3_per_nm)?);
        Ok(Trial {
            wear_factor_mm3_per_nm: factor_mm3_per_nm,
            mg_per_million_cycles: rate.ok_or(CompareError::RunTooShort { weighings: 0 })?,
        })
    }

    /// Mass lost after each update with another factor, as (cycles, mg), from nothing at the start.
    fn losses(&self, factor_mm3_per_nm: f64) -> Result<Vec<(f64, f64)>, CalibrateError> {
        let mut case = self.case.clone();
        case.wear = case.wear.with_constant(FACTOR.name, factor_mm3_per_nm)?;
        let failed = |source| CalibrateError::Run {
            factor_mm3_per_nm,
            source: Box::new(source),
        };
        let built = build(&case, 1, &Cache::off()).map_err(failed)?;
        let mut march = start(&case, built.test, &built.warnings).map_err(failed)?;
        let mut go_on = |_: Progress| ControlFlow::Continue(());
        while !march.is_done() {
            let update = march.update(&mut go_on);
            let update = update.map_err(|source| CalibrateError::March {
                factor_mm3_per_nm,
                source,
            })?;
            if update.is_break() {
                break;
            }
        }
        let updates = march.state().updates.iter();
        let losses = updates.map(|update| (update.cycles, update.mass_loss_mg));
        Ok(std::iter::once((0.0, 0.0)).chain(losses).collect())
    }
}

/// How far the rate of a trial is from `rate`, as a part of it.
fn off(trial: &Trial, rate: f64) -> f64 {
    trial.mg_per_million_cycles / rate - 1.0
}

/// The next factor: on the straight line through the two trials around the rate, or in proportion
/// to the nearest trial where none is on its other side. No wear factor, no wear: that is known.
fn guess(trials: &[Trial], rate: f64) -> f64 {
    const NOTHING: Trial = Trial {
        wear_factor_mm3_per_nm: 0.0,
        mg_per_million_cycles: 0.0,
    };
    let by_rate =
        |a: &&Trial, b: &&Trial| a.mg_per_million_cycles.total_cmp(&b.mg_per_million_cycles);
    let below = trials
        .iter()
        .filter(|trial| trial.mg_per_million_cycles < rate);
    let above = trials
        .iter()
        .filter(|trial| trial.mg_per_million_cycles >= rate);
    let low = below.max_by(by_rate).copied().unwrap_or(NOTHING);
    let Some(high) = above.min_by(by_rate) else {
        return low.wear_factor_mm3_per_nm * rate / low.mg_per_million_cycles;
    };
    let part = (rate - low.mg_per_million_cycles)
        / (high.mg_per_million_cycles - low.mg_per_million_cycles);
    low.wear_factor_mm3_per_nm + part * (high.wear_factor_mm3_per_nm - low.wear_factor_mm3_per_nm)
}

#[cfg(test)]
mod tests {
    use condyle::wear::{WEAR_LAWS, WearLawKind};
    use condyle_io::case::Wear;

    use super::*;

    fn trial(wear_factor_mm3_per_nm: f64, mg_per_million_cycles: f64) -> Trial {
        Trial {
            wear_factor_mm3_per_nm,
            mg_per_million_cycles,
        }
    }

    #[test]
    fn verify_the_first_guess_is_in_proportion_and_the_next_on_the_line_between() {
        let one = [trial(2.0, 10.0)];
        assert_eq!(guess(&one, 15.0), 3.0);
        assert_eq!(guess(&one, 5.0), 1.0);
        let two = [trial(2.0, 10.0), trial(3.0, 16.0)];
        assert_eq!(guess(&two, 13.0), 2.5);
    }

    #[test]
    fn verify_regula_falsi_finds_the_factor_of_a_bent_curve() {
        let rate = |factor: f64| factor + 0.05 * factor * factor;
        let mut trials = vec![trial(1.0, rate(1.0))];
        for _ in 0..5 {
            let next = guess(&trials, 3.0);
            trials.push(trial(next, rate(next)));
        }
        let found = trials
            .last()
            .map_or(0.0, |trial| trial.mg_per_million_cycles);
        assert!((found / 3.0 - 1.0).abs() < 1e-4, "{found}");
    }

    #[test]
    fn a_law_without_a_wear_factor_is_not_calibrated() {
        const OTHER: WearLawKind = WearLawKind {
            word: "other",
            about: "No wear.",
            known: condyle::parameter::Known::Chosen,
            parameters: &[],
            make: |_| WEAR_LAWS[0].law(&WEAR_LAWS[0].defaults()),
        };
        let error = CalibrateError::from(Wear::new(&OTHER).constant(FACTOR.name).unwrap_err());
        assert_eq!(
            error.to_string(),
            "no wear factor can be found: the wear law \"other\" has no \
             `wear_factor_mm3_per_nm`; take a case with a law that has"
        );
    }
}
