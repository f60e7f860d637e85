//! The reasons why a run and a measurement cannot be compared, or no constants of a wear law found from them.

use std::path::Path;

use condyle_case::{case::ConstantError, config::Problems};
use condyle_report::ReportError;
use thiserror::Error;

use crate::RunError;

/// The reason why a run and a measurement cannot be compared.
#[derive(Debug, Error)]
pub enum CompareError {
    /// The file of measured data cannot be read.
    #[error(transparent)]
    Measured(#[from] Problems),
    /// The results folder cannot be read.
    #[error(transparent)]
    Results(#[from] ReportError),
    /// Results or measurements that lack what the comparison needs, with the remedy.
    #[error("{0}")]
    NotComparable(String),
}

impl CompareError {
    /// Creates the error for a missing file of the results folder with which the table `[table]` of measured data is
    /// compared.
    pub(crate) fn missing_file(path: &Path, table: &str) -> Self {
        let path = path.display();
        Self::NotComparable(format!(
            "{path}: there is no such file; [{table}] is compared with it, so run the case again"
        ))
    }

    pub(crate) fn no_column(column: &str) -> Self {
        Self::NotComparable(format!(
            "the results have no column `{column}` to compare with; run the case again"
        ))
    }

    /// Creates the error for a run that ends before the weighings.
    pub(crate) fn run_too_short(weighings: usize) -> Self {
        Self::NotComparable(format!(
            "the run ends before the second weighing that counts: it reaches {weighings} such weighings, and two are \
             needed; run more cycles ([march] cycles), or lower fit_from_cycles"
        ))
    }
}

/// The reason why no constants of a wear law can be found.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The comparison with the weighings failed.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The case of a results folder, or one to predict.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A value that a constant does not accept.
    #[error("the constants cannot be calibrated: {0}")]
    Constant(#[from] ConstantError),
    /// Tests and constants that do not match; the text includes the remedy.
    #[error("{0}")]
    Unsuitable(String),
    /// A run with other constants failed.
    #[error("with {constants}: {source}")]
    Run {
        constants: String,
        source: Box<RunError>,
    },
}

impl CalibrateError {
    /// Returns whether the physics could not be solved, as opposed to bad input.
    pub fn is_physics(&self) -> bool {
        matches!(self, Self::Run { source, .. } if source.is_physics())
    }
}
