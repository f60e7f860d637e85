//! Why a study is not done.

use std::{io, path::PathBuf};

use condyle_case::config::Problems;
use condyle_lab::RunError;
use condyle_report::ReportError;
use condyle_results::ResultsError;
use thiserror::Error;

/// Why a study is not done.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The study file or its case.
    #[error(transparent)]
    Study(#[from] Problems),
    /// A design with more inputs than its points have axes.
    #[error(
        "a {design} design takes {most} inputs at most, and the study has {inputs}; use kind = \"latin-hypercube\", or \
         let fewer inputs vary"
    )]
    TooManyInputs {
        /// Its word.
        design: &'static str,
        /// Inputs it takes.
        most: usize,
        /// Inputs of the study.
        inputs: usize,
    },
    /// More tests than anybody waits for.
    #[error(
        "the study has {tests:.3e} tests, and {most:.0e} are the most; take fewer levels, points or inputs"
    )]
    TooManyTests {
        /// Tests of the study.
        tests: f64,
        /// Tests at most.
        most: f64,
    },
    /// Correlations that contradict each other.
    #[error("the correlations cannot all hold at once; make them weaker, or leave one out")]
    Contradiction,
    /// A folder of another study.
    #[error(
        "{}: the folder holds another study{}; give another one with --out, or remove it",
        folder.display(),
        if *is_shard { ", or another shard of this one" } else { "" }
    )]
    OtherStudy {
        /// The folder.
        folder: PathBuf,
        /// Whether only its shard is another.
        is_shard: bool,
    },
    /// A folder without a study.
    #[error("{}: the folder holds no study; give one that `condyle study` wrote", folder.display())]
    NoStudy {
        /// The folder.
        folder: PathBuf,
    },
    /// A folder that holds something else.
    #[error("{}: the folder is not empty and holds no study; give another one with --out", folder.display())]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
    },
    /// A row that the study does not have.
    #[error("the study has no row {row}; its rows are 0 to {}", tests - 1)]
    NoRow {
        /// As given.
        row: u64,
        /// Tests of the study.
        tests: u64,
    },
    /// A row of a search that is not known before the rows above are.
    #[error("row {row} of a search is known once it has been tried; run the study first")]
    NotYet {
        /// As given.
        row: u64,
    },
    /// A search is not cut into parts.
    #[error(
        "a search goes from test to test, and cannot be cut into shards; run it on one machine"
    )]
    NoShards,
    /// The database.
    #[error("{}: {source}; check that the disk is not full and the file can be written", path.display())]
    Store {
        /// The file.
        path: PathBuf,
        /// Why.
        source: rusqlite::Error,
    },
    /// The system refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The folder is in use.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// The page.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// One test made into a whole run.
    #[error(transparent)]
    Run(#[from] RunError),
}
