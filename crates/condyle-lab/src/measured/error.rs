//! The reasons why a run and a measurement cannot be compared.

use std::path::PathBuf;

use condyle_case::config::Problems;
use condyle_mesh::formats::MeshFileError;
use condyle_report::ReportError;
use condyle_results::DamagedFile;
use thiserror::Error;

/// A comparison could not be made.
#[derive(Debug, Error)]
pub enum CompareError {
    /// The file of measured data.
    #[error(transparent)]
    Measured(#[from] Problems),
    /// The results folder.
    #[error(transparent)]
    Results(#[from] ReportError),
    /// A mesh of the results folder that is no longer what the run wrote.
    #[error(transparent)]
    Damaged(#[from] DamagedFile),
    /// A mesh of the results folder.
    #[error(transparent)]
    Mesh(#[from] MeshFileError),
    /// A file of the results folder that is needed.
    #[error("{}: there is no such file, which [{table}] is compared with; run the case again", path.display())]
    MissingFile {
        /// The file.
        path: PathBuf,
        /// The table of measured data that needs it.
        table: &'static str,
    },
    /// A column that the run did not write.
    #[error("the results have no column `{column}` to compare with; run the case again")]
    NoColumn {
        /// Its name.
        column: &'static str,
    },
    /// A column without any part that can be compared.
    #[error(
        "the measured points of `{column}` are all more than {gap} % of the cycle apart, so nothing \
         is compared; raise largest_gap_percent in [kinematics], or leave the column out"
    )]
    NothingMeasured {
        /// Its name.
        column: &'static str,
        /// The largest gap that is crossed, percent.
        gap: f64,
    },
    /// A run that ends before the weighings do.
    #[error(
        "the run ends before the second weighing that counts: it reaches {weighings} of them, of \
         which two are needed; run more cycles ([march] cycles), or lower fit_from_cycles"
    )]
    RunTooShort {
        /// Weighings that count and that the run reaches.
        weighings: usize,
    },
    /// A scan that starts too far from the insert.
    #[error(
        "only {near} of {points} points of the scan come near the insert where they are to be laid \
         onto it; check length_unit, axes, start_mm and the fit region in [surface]"
    )]
    ScanElsewhere {
        /// Points near enough.
        near: usize,
        /// Points of the scan.
        points: usize,
    },
    /// A scan whose shape does not fix its place.
    #[error(
        "the surface that the scan is laid onto does not fix its place: it can slide or turn along \
         itself; scan more of the insert, or fit all of it (fit = \"all\" in [surface])"
    )]
    ScanSlides,
    /// A registration that does not come to rest.
    #[error(
        "the scan does not come to rest on the insert within {iterations} steps: the last moved it \
         by {step_mm:.4} mm; start it nearer with axes and start_mm in [surface]"
    )]
    ScanRestless {
        /// Steps made.
        iterations: usize,
        /// Length of the last one, mm.
        step_mm: f64,
    },
    /// A scan that covers no node.
    #[error(
        "the registered scan covers no node of the insert within {farthest_mm} mm; raise \
         farthest_mm in [surface], or scan more of the insert"
    )]
    NothingScanned {
        /// The distance at which points are left out, mm.
        farthest_mm: f64,
    },
    /// The two meshes of a run do not belong together.
    #[error(
        "the first and the last mesh of the results have {first} and {last} nodes on the surface; \
         run the case again"
    )]
    OtherMesh {
        /// Nodes of the first.
        first: usize,
        /// Nodes of the last.
        last: usize,
    },
    /// A file that cannot be written.
    #[error("{}: cannot be written: {source}; choose another folder with --out", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
}
