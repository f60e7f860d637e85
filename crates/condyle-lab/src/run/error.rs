//! Errors of runs.

use std::{
    io,
    path::{Path, PathBuf},
};

use condyle::evolve::{MarchError, PlacementError};
use condyle_case::{
    case::{AssignmentError, BuildError, Case, ChangeError},
    config::Problems,
};
use condyle_results::ResultsError;
use thiserror::Error;

/// A failed run.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, Error)]
pub enum RunError {
    /// The case file has problems, its bodies cannot be built, or a run would need more memory than it allows.
    #[error(transparent)]
    Case(#[from] Problems),
    /// The case cannot be changed as requested.
    #[error(transparent)]
    Change(#[from] AssignmentError),
    /// A mesh that can no longer be read.
    #[error("a mesh of the case cannot be read: {0}; check the paths in the case")]
    Inputs(#[source] io::Error),
    /// The results folder cannot be used.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The report cannot be written.
    #[error(transparent)]
    Report(#[from] condyle_report::ReportError),
    /// Bodies that do not settle on each other.
    #[error("{shown}")]
    Placement {
        source: PlacementError,
        /// The same at the key of the case that causes it.
        shown: Problems,
    },
    /// The physics could not be solved.
    #[error("{source}{}", kept_in(out.as_deref()))]
    March {
        source: MarchError,
        out: Option<PathBuf>,
    },
}

impl From<ChangeError> for RunError {
    fn from(error: ChangeError) -> Self {
        match error {
            ChangeError::Case(problems) => Self::Case(problems),
            ChangeError::Assignment(error) => Self::Change(error),
        }
    }
}

impl RunError {
    pub(crate) fn of_build(case: &Case, source: &BuildError) -> Self {
        Self::Case(case.at_its_key(source))
    }

    /// Returns whether the physics could not be solved, as opposed to bad input.
    pub fn is_physics(&self) -> bool {
        matches!(
            self,
            Self::March { .. }
                | Self::Placement {
                    source: PlacementError::NotSettled { .. } | PlacementError::Unsteady { .. },
                    ..
                }
        )
    }

    /// Returns the error with its place in the case file, if it has one.
    pub fn in_case(&self) -> Option<&Problems> {
        match self {
            Self::Case(shown) | Self::Placement { shown, .. } => Some(shown),
            _ => None,
        }
    }
}

fn kept_in(out: Option<&Path>) -> String {
    let kept = |out: &Path| format!("; what was computed is kept in {}", out.display());
    out.map_or_else(String::new, kept)
}
