//! Errors between a results folder and its report.

use std::path::{Path, PathBuf};

/// A report could not be made.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// There is no such folder, or it lacks what the report needs; the text includes the remedy.
    #[error("{0}")]
    Unusable(String),
    /// The system refuses to read or write a file.
    #[error("The file {path} cannot be {action}: {source}.")]
    Inaccessible {
        path: PathBuf,
        action: &'static str,
        source: std::io::Error,
    },
    /// A file does not hold what a run writes into it.
    #[error("{} {problem}.", place(path, *line))]
    Content {
        path: PathBuf,
        /// Line in the file, from 1, where the problem is in one line.
        line: Option<usize>,
        /// The problem, a sentence whose subject is the file or its line.
        problem: String,
    },
    /// A mesh differs from the one that the run wrote.
    #[error(transparent)]
    Damaged(#[from] condyle_results::DamagedFile),
    /// A mesh cannot be parsed.
    #[error(transparent)]
    Mesh(#[from] condyle_mesh::formats::MeshFileError),
}

impl ReportError {
    pub(crate) fn no_results(folder: &Path) -> Self {
        let folder = folder.display();
        Self::Unusable(format!(
            "The folder {folder} holds no results: no summary.json, wear.csv, kinematics.csv or insert_*.vtu. Give the folder \
            that `condyle run --out` wrote."
        ))
    }

    pub(crate) fn content(path: &Path, problem: impl Into<String>) -> Self {
        Self::Content {
            path: path.to_owned(),
            line: None,
            problem: problem.into(),
        }
    }
}

fn place(path: &Path, line: Option<usize>) -> String {
    let path = path.display();
    line.map_or_else(
        || format!("The file {path}"),
        |line| format!("Line {line} of {path}"),
    )
}
