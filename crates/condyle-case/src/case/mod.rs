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
#[cfg(feature = "file-system")]
mod draft_hip;
mod drive;
mod femur;
mod frame;
mod insert;
mod key_location;
mod ligament;
mod machine;
mod material;
mod pressure_table;
mod reader;
mod renamed;
mod rig;
mod rig_joint;
mod rig_spring;
mod run_options;
#[cfg(test)]
mod tests;
mod waveform;
mod wear;

// Only some of these items are public; the others are for the files of this module.
pub(crate) use self::waveform::parts_of_a_cycle;
pub use self::{
    activity::*, assignment::*, build::*, contact::*, contents::*, drive::*, femur::*, frame::*,
    insert::*, ligament::*, machine::*, material::*, pressure_table::*, reader::*, rig::*,
    rig_joint::*, rig_spring::*, run_options::*, wear::*,
};

#[cfg(feature = "file-system")]
pub use draft::{DraftError, Drafted};
