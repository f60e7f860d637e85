//! Why a study is not done.

use std::{io, path::PathBuf};

use condyle_report::ReportError;
use thiserror::Error;

use super::super::ConvergeError;

/// Why a study is not done.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The runs.
    #[error(transparent)]
    Converge(#[from] ConvergeError),
    /// The results of a run.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A run that lacks what the study needs.
    #[error("{}: there is no {what} in it; the study needs whole results folders", folder.display())]
    Lacking {
        /// The results folder.
        folder: PathBuf,
        /// What it lacks.
        what: &'static str,
    },
    /// The system refused to write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
}
