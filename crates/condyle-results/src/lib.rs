//! The results of a run: the [`catalogue`] of quantities, the results folder and its readers.
//!
//! A run writes a folder with one file per table, all readable without condyle; [`Summary`] is its `summary.json`.

mod added;
pub mod catalogue;
mod checkpoint;
mod cycle_files;
mod declared;
mod digits;
mod error_estimate;
#[cfg(feature = "file-system")]
mod files;
#[cfg(feature = "file-system")]
mod folder;
mod insert_fields;
mod parts;
mod prediction;
mod settings;
mod side;
#[cfg(feature = "file-system")]
mod slip_paths;
pub mod statistics;
mod summary;
mod tables;
#[cfg(feature = "file-system")]
mod write_over;

/// The columns of `kinematics.csv`.
pub use condyle::machine::{
    CycleQuantity, JointKind, TestedJoint,
    knee::{KNEE, LATERAL, MEDIAL},
};
pub use condyle::parameter::split_unit;

pub use added::{
    AddedFiles, COMPARED, COMPARED_KINEMATICS, COMPARED_NUMBERS, COMPARED_SURFACE, COMPARED_WEAR,
    KINEMATICS_PICTURE, MAP_PICTURES, PLOTTED, SLIP_PATHS_PICTURE, WEAR_PICTURE,
};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use cycle_files::{
    BODIES, KeptCycle, cycle_pressure_csv, cycle_pressure_file, cycle_pvd, femur_on_side,
    femur_vtu, frame_name, insert_frame,
};
pub use declared::results_schema;
pub use digits::with_digits;
pub use error_estimate::{ErrorEstimate, ErrorParts, Part, QuantityError, QuantityErrors};
#[cfg(feature = "file-system")]
pub use files::{DamagedFile, FolderLock, check_file, create_file, replace_file};
#[cfg(feature = "file-system")]
pub use folder::{Found, ResultsError, ResultsFolder};
pub use insert_fields::{
    InsertFields, NODE_FIELDS, NodeField, insert_file_name, insert_pvd, insert_vtu,
};
pub use parts::{
    ActivitySummary, KneeActivity, LawWear, MotionColumn, NeutralAngles, NeutralPose, joint_range,
    kinematics_file,
};
pub use prediction::{CALIBRATED_LAW, Interval, MAX_FACTOR_OF_RUN, Prediction, Source};
pub use settings::{SettingDifference, setting_differences};
pub use side::{Directions, Side, point_on_side};
pub use summary::{PARTS, PartKind, PlausibilityWarning, Summary, SummaryPart, json_text};
pub use tables::{WEAR_COLUMNS, WearColumn, femur_pose_csv, kinematics_csv, wear_csv};
