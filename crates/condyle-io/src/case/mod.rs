//! The case file: TOML in, a checked and typed [`Case`] out, and back.
//!
//! Values stay in the units of their names; they become mm, N, s, MPa, tonne and rad only in the
//! last step, where a case is built.

mod accuracy;
mod activity;
mod activity_reason;
mod assignment;
mod axes;
mod backside;
mod build;
mod channel;
mod contact;
mod contents;
mod creep;
mod cross_linking;
#[cfg(feature = "file-system")]
mod draft;
mod drive_reason;
mod femur;
mod fingerprint;
mod heading;
mod insert;
mod json_schema;
mod key_location;
mod key_names;
mod law_change;
mod limits;
mod machine;
mod machine_keys;
mod machine_write;
mod march;
mod material;
mod mesh_file;
mod number_keys;
#[cfg(feature = "file-system")]
mod on_disk;
mod origin;
mod output;
mod overriding;
mod placement;
mod plasticity;
mod pressure_table;
mod read;
mod reader;
mod schema;
#[cfg(test)]
mod tests;
mod time;
mod waveform;
mod wear;
mod write;

pub use accuracy::Accuracy;
pub use activity::{Activities, Activity, ActivityKeys};
pub use activity_reason::ActivityReason;
pub use assignment::{Assignment, AssignmentError, ChangeError};
pub use axes::{Axes, AxesError, AxesReason};
pub use backside::{BacksideChoice, RestingBackside};
pub(crate) use build::in_four;
pub use build::{
    Body, BuildError, BuildWarning, Built, FEMUR_TRIANGLES, SharedBodies, StrayPiece, WrongAxes,
};
pub use channel::CaseChannel;
pub use contact::{
    Contact, ContactModelWord, Finding, Friction, FrictionModelWord, PressureLawChoice, SearchWord,
    SofteningCurve,
};
pub use contents::Case;
pub use creep::{Creep, LogarithmicCreep};
pub use cross_linking::{CrossLinking, HighlyCrossLinked, ModeratelyCrossLinked};
#[cfg(feature = "file-system")]
pub use draft::{Draft, DraftError, Drafted};
pub use drive_reason::DriveReason;
pub use femur::{CylinderFemur, Femur, GenericFemur, MeshFemur, SphereFemur};
pub use heading::{Heading, Side};
pub use insert::{FlatInsert, GenericInsert, HexahedralInsert, Insert, MeshInsert};
pub use json_schema::json_schema;
pub use key_location::CaseConflict;
pub use key_names::KeyNameError;
pub use limits::Limits;
pub use machine::{Freedom, Freedoms, Machine, Waveforms};
pub use machine_keys::{
    DriveWord, MachineSettings, Preset, Rotation, Sign, Springs, StiffnessOf, Translation,
};
pub use march::{AutoUpdates, FixedUpdates, March, Update};
pub use material::Material;
pub use mesh_file::LengthUnit;
pub use number_keys::NumberKey;
pub use output::Output;
pub use overriding::{Override, OverrideError};
pub use placement::{FemurPlacement, InsertOrigin, InsertPlacement};
pub use plasticity::{FirstYield, J2Plasticity, PlasticityChoice, PlasticityReason};
pub use pressure_table::{PressureTableReason, StrainTable, TableError};
pub use reader::CaseReader;
pub use schema::schema_markdown;
pub use time::{IntegratorWord, Time};
pub use waveform::{InterpolationWord, WaveformReason};
pub use wear::{ConstantError, Wear, WearLaws};
pub use write::template;

pub(crate) use axes::check as check_axes;
