//! Why a run failed.

use std::{io, path::PathBuf};

use condyle::evolve::{MarchError, PlacementError};
use condyle_io::{
    case::{AssignmentError, BuildError},
    keyed::Problems,
    results::ResultsError,
};
use thiserror::Error;

/// Why a run failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The case file.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A change of the case that cannot be made.
    #[error(transparent)]
    Change(#[from] AssignmentError),
    /// The bodies that the case describes.
    #[error("{shown}")]
    Build {
        /// Why.
        source: BuildError,
        /// The same at the key of the case that is behind it.
        shown: Problems,
    },
    /// A mesh that went away.
    #[error("a mesh of the case cannot be read: {0}; check the paths in the case")]
    Inputs(#[source] io::Error),
    /// The results folder.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The report.
    #[error(transparent)]
    Report(#[from] condyle_report::ReportError),
    /// Two bodies that make no knee.
    #[error("{shown}")]
    Placement {
        /// Why.
        source: PlacementError,
        /// The same at the key of the case that is behind it.
        shown: Problems,
    },
    /// The physics.
    #[error("{source}; what was computed is kept in {}", out.display())]
    March {
        /// Why.
        source: MarchError,
        /// Where the results so far are.
        out: PathBuf,
    },
}

impl RunError {
    /// Whether the physics could not be solved, rather than the input being wrong.
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

    /// The error with its place in the case file, where it has one.
    pub fn in_case(&self) -> Option<&Problems> {
        match self {
            Self::Case(shown) | Self::Build { shown, .. } | Self::Placement { shown, .. } => {
                Some(shown)
            }
            Self::Change(_)
            | Self::Inputs(_)
            | Self::Results(_)
            | Self::Report(_)
            | Self::March { .. } => None,
        }
    }
}
