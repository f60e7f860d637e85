//! The reasons why a study fails.

use std::{
    io,
    path::{Path, PathBuf},
};

use condyle_case::{case::AssignmentError, config::Problems};
use condyle_lab::RunError;
use condyle_report::ReportError;
use condyle_results::ResultsError;
use thiserror::Error;

/// The reason why a study fails.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The study file or its case has problems.
    #[error(transparent)]
    Study(#[from] Problems),
    /// The case does not accept the key or a value of a convergence study.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
    /// The tests cannot be planned or run as requested; the text includes the remedy.
    #[error("{0}")]
    Plan(String),
    /// The study cannot use the folder.
    #[error("{}: {problem}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Its content, and the remedy.
        problem: &'static str,
    },
    /// The listener stopped the study; stored tests are kept.
    #[error("interrupted")]
    Interrupted,
    /// The database cannot be used.
    #[error("{}: {source}; check that the disk is not full and the file can be written", path.display())]
    Store {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: rusqlite::Error,
    },
    /// The system refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// The folder is in use.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The page cannot be written.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// The unchanged case, to which every answer refers, does not run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A run that the study compares with the others fails.
    #[error("{number}: {source}")]
    RunWith {
        /// The key and its value, such as `march.updates = 1`.
        number: String,
        /// The reason.
        source: Box<RunError>,
    },
}

impl StudyError {
    pub(crate) fn folder(folder: &Path, problem: &'static str) -> Self {
        let folder = folder.to_path_buf();
        Self::Folder { folder, problem }
    }

    pub(crate) fn no_shards() -> Self {
        let problem = "the tests of a search depend on earlier ones, so that it cannot be cut into shards; run it on one machine";
        Self::Plan(problem.to_owned())
    }

    /// Converts a system error to the error for a file or folder that the system refuses to read or write.
    pub(crate) fn refused(path: &Path) -> impl Fn(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Refused {
            path: path.clone(),
            source,
        }
    }
}
