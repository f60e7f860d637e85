//! The reasons why a study fails.

use std::{
    error::Error,
    path::{Path, PathBuf},
};

use condyle_case::{case::AssignmentError, config::Problems};
use condyle_lab::RunError;
use condyle_report::ReportError;
use condyle_results::ResultsError;

/// The reason why a study fails.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The study file or its case has problems.
    #[error(transparent)]
    Study(#[from] Problems),
    /// The case does not accept the key or a value of a convergence study.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
    /// The tests cannot be planned or run as requested, or the folder cannot be used; the text includes the remedy.
    #[error("{0}")]
    Plan(String),
    /// The listener stopped the study; stored tests are kept.
    #[error("interrupted")]
    Interrupted,
    /// The system or the database refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        path: PathBuf,
        source: Box<dyn Error + Send + Sync>,
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
        source: Box<RunError>,
    },
}

impl StudyError {
    pub(crate) fn folder(folder: &Path, problem: &str) -> Self {
        Self::Plan(format!("{}: {problem}", folder.display()))
    }

    pub(crate) fn no_shards() -> Self {
        let problem = "the tests of this design depend on earlier ones, so it cannot be divided into shards; run it on \
                       one machine";
        Self::Plan(problem.to_owned())
    }

    /// Converts an error of the system or the database to the error for a file or folder that it refuses to read or write.
    pub(crate) fn refused<E: Into<Box<dyn Error + Send + Sync>>>(
        path: &Path,
    ) -> impl Fn(E) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Refused {
            path: path.clone(),
            source: source.into(),
        }
    }
}
