//! The case file: TOML in, a checked and typed [`Case`] out, and back.
//!
//! Values stay in the units of their names; they become mm, N, s, MPa, tonne and rad only in the
//! last step, where a case is built.

mod activity;
mod assignment;
mod build;
mod contact;
mod contents;
#[cfg(feature = "file-system")]
mod draft;
mod femur;
mod frame;
mod insert;
mod key_location;
mod machine;
mod material;
mod pressure_table;
mod reader;
mod renamed;
mod run_options;
mod schedule;
#[cfg(test)]
mod tests;
mod waveform;
mod wear;

pub use activity::{Activities, Activity, ActivityKeys};
pub use assignment::{Assignment, AssignmentError, ChangeError};
pub use build::{Body, BuildError, BuildWarning, Built, FEMUR_TRIANGLES, SharedBodies};
pub use contact::{
    BacksideChoice, Contact, ContactModelChoice, DeformableContact, FoundationContact,
    J2Plasticity, PlasticityChoice, PressureLawChoice, RestingBackside, SofteningCurve,
};
pub use contents::{Case, Origin, json_schema, schema_markdown};
pub use femur::{
    CylinderFemur, Femur, FemurPlacement, FemurShape, GenericFemur, MeshFemur, SphereFemur,
};
pub use frame::{Axes, AxesError, Heading, LengthUnit, Side};
pub use insert::{
    FlatInsert, GenericInsert, HexahedralInsert, Insert, InsertOrigin, InsertPlacement,
    InsertShape, MeshInsert,
};
pub use machine::{
    DriveWord, Freedom, Freedoms, Machine, MachineSettings, Preset, Sign, Springs, StiffnessOf,
    Waveforms,
};
pub use material::{
    Creep, CrossLinking, HighlyCrossLinked, LogarithmicCreep, Material, ModeratelyCrossLinked,
};
pub use pressure_table::{StrainTable, TableError};
pub use reader::{CaseReader, template};
pub use run_options::{Accuracy, Limits, Output};
pub use schedule::{AutoUpdates, FixedUpdates, IntegratorWord, March, Time, Update};
pub use wear::{ConstantError, Wear, WearLaws};

#[cfg(feature = "file-system")]
pub use draft::{Draft, DraftError, Drafted};

pub(crate) use build::in_four;
pub(crate) use frame::check_axes;
