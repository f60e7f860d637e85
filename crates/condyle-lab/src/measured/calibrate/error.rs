//! The reasons why no constants of a wear law can be found.

use std::path::PathBuf;

use condyle::evolve::MarchError;
use condyle_case::{case::ConstantError, config::Problems};
use thiserror::Error;

use super::super::error::CompareError;
use crate::RunError;

/// The reason why no constants of a wear law can be found.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The comparison with the weighings.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The case of a results folder, or one to predict.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A value that a constant cannot have.
    #[error("no constants can be found: {0}")]
    Constant(#[from] ConstantError),
    /// An unknown constant.
    #[error("the wear law \"{law}\" has no constant `{name}`; it has {known}")]
    UnknownConstant {
        /// Word of the law.
        law: &'static str,
        /// The name asked for.
        name: String,
        /// The names that it has.
        known: String,
    },
    /// A results folder without measured data.
    #[error(
        "give a results folder and a file of measured data for each test: {given} paths are no pairs"
    )]
    NoPairs {
        /// Paths given.
        given: usize,
    },
    /// Tests that ran with other laws.
    #[error(
        "{}: this run has the wear law \"{law}\", and the first one has \"{first}\"; run all with one law \
         (--set wear.law={first})", results.display()
    )]
    OtherLaw {
        /// The folder.
        results: PathBuf,
        /// Its law.
        law: &'static str,
        /// That of the first test.
        first: &'static str,
    },
    /// Intervals of two kinds.
    #[error(
        "{}: [gravimetric] interval and confidence_percent are not those of the first test; tests that are fitted \
         together need one kind of interval", measured.display()
    )]
    OtherInterval {
        /// The measured data.
        measured: PathBuf,
    },
    /// More constants than tests.
    #[error(
        "{tests} measured rate{} cannot tell {constants} constants; give as many tests as constants, or fewer --constant",
        if *tests == 1 { "" } else { "s" }
    )]
    TooFewTests {
        /// Tests given.
        tests: usize,
        /// Constants asked for.
        constants: usize,
    },
    /// Constants whose effects on the rates cannot be separated.
    #[error(
        "these tests do not tell the constants apart: some change of them leaves every rate as it is; give tests that \
         differ more in what the law goes by, or fewer --constant"
    )]
    NotTold,
    /// A run with other constants.
    #[error("with {constants}: {source}")]
    Run {
        /// The constants.
        constants: String,
        /// The reason.
        source: Box<RunError>,
    },
    /// The physics with other constants.
    #[error("with {constants}: {source}")]
    March {
        /// The constants.
        constants: String,
        /// The reason.
        source: MarchError,
    },
    /// Measured data without weighings.
    #[error("the measured data have no [gravimetric] table, which a wear law is calibrated by")]
    NotWeighed,
    /// Specimens that lost nothing.
    #[error(
        "the measured wear rate is {mg_per_million_cycles:.3} mg per million cycles: there are no \
         constants that make a prediction of it; check the masses and the soak controls"
    )]
    NoWear {
        /// The rate.
        mg_per_million_cycles: f64,
    },
    /// A run that wears nothing.
    #[error(
        "{}: the run wears nothing with {constants}, so its wear cannot be scaled; if that is a wear factor \
         of 0, give it one above 0, and run it again", results.display()
    )]
    RunWithoutWear {
        /// The folder.
        results: PathBuf,
        /// The constants.
        constants: String,
    },
    /// A search that does not end.
    #[error(
        "after {steps} steps the rates would still change by {left_percent:.2} %; use more updates or increments in \
         the cases, or start from other constants"
    )]
    NotFound {
        /// Steps made.
        steps: usize,
        /// By how much the last step would change a rate.
        left_percent: f64,
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
