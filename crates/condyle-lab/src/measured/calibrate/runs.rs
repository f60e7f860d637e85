//! Tests that are run again with other constants.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use condyle::evolve::Progress;
use condyle_io::{
    cache::Cache,
    case::{Case, Wear},
};
use serde::Serialize;

use super::super::{CompareError, GravimetricComparison, compare};
use super::{CalibrateError, free::in_words};
use crate::run::{build, start};

/// A run, and the weighings that it is to meet.
pub(super) struct Test {
    /// The results folder.
    pub(super) results: PathBuf,
    /// The measured data.
    pub(super) measured: PathBuf,
    /// The case that was run.
    pub(super) case: Case,
    /// Both held against each other.
    pub(super) weighed: GravimetricComparison,
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
    /// Reads a results folder and measured data.
    pub(super) fn read(results: &Path, measured: &Path) -> Result<Self, CalibrateError> {
        let comparison = compare(results, measured)?;
        Ok(Self {
            weighed: comparison.gravimetric.ok_or(CalibrateError::NotWeighed)?,
            case: Case::read(&results.join("case.toml"))?,
            results: results.to_owned(),
            measured: measured.to_owned(),
        })
    }

    /// An error where there is nothing to make a prediction of, or by.
    pub(super) fn check(&self) -> Result<(), CalibrateError> {
        let mg_per_million_cycles = self.weighed.aim().mg_per_million_cycles;
        if mg_per_million_cycles <= 0.0 || !mg_per_million_cycles.is_finite() {
            return Err(CalibrateError::NoWear {
                mg_per_million_cycles,
            });
        }
        if self.weighed.predicted.mg_per_million_cycles <= 0.0 {
            return Err(CalibrateError::RunWithoutWear {
                results: self.results.clone(),
                constants: in_words(&self.case.wear),
            });
        }
        Ok(())
    }

    /// Its rate with another law, in memory; that of the folder where the law is the same.
    pub(super) fn rate(&self, law: &Wear) -> Result<f64, CalibrateError> {
        if *law == self.case.wear {
            return Ok(self.weighed.predicted.mg_per_million_cycles);
        }
        let rate = self.weighed.rate_of(&losses(&self.case, law)?);
        Ok(rate.ok_or(CompareError::RunTooShort { weighings: 0 })?)
    }
}

/// Mass lost after each update of a case with another law, as (cycles, mg), from nothing at the start.
pub(super) fn losses(case: &Case, law: &Wear) -> Result<Vec<(f64, f64)>, CalibrateError> {
    let mut case = case.clone();
    case.wear = law.clone();
    let failed = |source| CalibrateError::Run {
        constants: in_words(law),
        source: Box::new(source),
    };
    let built = build(&case, 1, &Cache::off()).map_err(failed)?;
    let mut march = start(&case, built.test, &built.warnings).map_err(failed)?;
    let mut go_on = |_: Progress| ControlFlow::Continue(());
    while !march.is_done() {
        let update = march.update(&mut go_on);
        let update = update.map_err(|source| CalibrateError::March {
            constants: in_words(law),
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
