//! The results folder: what a run writes, one file a table, all readable without condyle.

mod checkpoint;
mod error_estimate;
mod folder;
mod insert_series;
mod replace;
mod summary;
mod tables;

/// What the columns of `kinematics.csv` are.
pub use condyle::machine::{
    CycleQuantity, JointKind,
    knee::{KNEE, LATERAL, MEDIAL},
};

pub use checkpoint::{Checkpoint, CheckpointError};
pub use error_estimate::{ErrorEstimate, ErrorParts, Part};
pub use folder::{Found, ResultsError, ResultsFolder};
pub use insert_series::insert_file_name;
pub use summary::{Summary, SummaryInput};
