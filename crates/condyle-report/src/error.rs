//! What can go wrong between a results folder and its report.

use std::path::PathBuf;

/// A report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The path is not a folder.
    #[error("There is no folder {folder}. Give the folder that `condyle run --out` wrote.")]
    NoFolder {
        /// The path asked for.
        folder: PathBuf,
    },
    /// The folder holds none of the files that a run writes.
    #[error(
        "The folder {folder} holds no results: no summary.json, wear.csv, kinematics.csv or insert_*.vtu. Give the folder that `condyle run --out` wrote."
    )]
    NoResults {
        /// The path asked for.
        folder: PathBuf,
    },
    /// The folder holds results, and none of them can be read.
    #[error("Nothing in the folder {folder} can be read. {reasons}")]
    NothingReadable {
        /// The path asked for.
        folder: PathBuf,
        /// Why, a sentence a file.
        reasons: String,
    },
    /// A file that one picture needs is not in the folder.
    #[error(
        "The file {path} is missing, and {picture} cannot be drawn without it. Run the case again."
    )]
    MissingFile {
        /// The file.
        path: PathBuf,
        /// The picture that needs it.
        picture: &'static str,
    },
    /// A file is there and cannot be read.
    #[error("The file {path} cannot be read: {source}.")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error("The file {path} cannot be written: {source}.")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A summary is not JSON, or not an object.
    #[error("The file {path} is not a summary in JSON: {source}. Run the case again.")]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong, with line and column.
        source: serde_json::Error,
    },
    /// A case file is no TOML.
    #[error("The file {path} is not a case: {message}.")]
    NotACase {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// A table does not end with the end of a line.
    #[error("The file {path} is cut short: its last line does not end.")]
    CutShort {
        /// The file.
        path: PathBuf,
    },
    /// A table holds something that is not a number.
    #[error("Line {line} of {path}: column `{column}` holds `{text}`, which is not a number.")]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// Line in the file, from 1.
        line: usize,
        /// Name of the column.
        column: String,
        /// What stands there.
        text: String,
    },
    /// A row of a table is longer or shorter than its header.
    #[error("Line {line} of {path} has {found} values; its header names {expected} columns.")]
    RaggedRow {
        /// The file.
        path: PathBuf,
        /// Line in the file, from 1.
        line: usize,
        /// Values in the row.
        found: usize,
        /// Columns in the header.
        expected: usize,
    },
    /// A table lacks the columns of a picture, or has no row.
    #[error("{path} has no rows with the columns {columns}, which {picture} needs.")]
    MissingColumns {
        /// The file.
        path: PathBuf,
        /// The columns, separated by commas.
        columns: &'static str,
        /// The picture that needs them.
        picture: &'static str,
    },
    /// A mesh is no longer what the run wrote.
    #[error(transparent)]
    Damaged(#[from] condyle_results::DamagedFile),
    /// A mesh is damaged.
    #[error(transparent)]
    Mesh(#[from] condyle_mesh::formats::MeshFileError),
    /// A mesh lacks a field of a picture.
    #[error("The mesh {path} has no point data `{field}`.")]
    MissingField {
        /// The file.
        path: PathBuf,
        /// Name of the point data.
        field: &'static str,
    },
    /// A field of a mesh has the wrong length.
    #[error("The mesh {path} has {nodes} nodes, but {found} values of `{field}`.")]
    FieldLength {
        /// The file.
        path: PathBuf,
        /// Name of the point data.
        field: String,
        /// Values found.
        found: usize,
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// No face of a mesh is marked as articulating.
    #[error("The mesh {path} has no face whose nodes all have `articulating` = 1.")]
    NoSurface {
        /// The file.
        path: PathBuf,
    },
}
