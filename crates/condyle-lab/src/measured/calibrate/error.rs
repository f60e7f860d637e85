//! The reasons why no constants of a wear law can be found.

use condyle_case::{case::ConstantError, config::Problems};
use thiserror::Error;

use super::super::error::CompareError;
use crate::RunError;

/// The reason why no constants of a wear law can be found.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The comparison with the weighings failed.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The case of a results folder, or one to predict.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A value that a constant does not accept.
    #[error("no constants can be found: {0}")]
    Constant(#[from] ConstantError),
    /// Tests and constants that do not match; the text includes the remedy.
    #[error("{0}")]
    Unsuitable(String),
    /// A run with other constants failed.
    #[error("with {constants}: {source}")]
    Run {
        /// The constants.
        constants: String,
        /// The reason.
        source: Box<RunError>,
    },
}

impl CalibrateError {
    /// Returns whether the physics could not be solved, as opposed to bad input.
    pub fn is_physics(&self) -> bool {
        matches!(self, Self::Run { source, .. } if source.is_physics())
    }
}
