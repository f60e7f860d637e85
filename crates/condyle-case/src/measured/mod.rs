//! Measured data that a run is compared with: a TOML file in, checked and typed data out.
//!
//! The file names any of three: kinematics, gravimetric wear, and a scan of the worn surface. Its
//! problems are reported as those of a case are: all at once, each with a caret under its place.

mod file;
mod gravimetric;
mod kinematics;
mod reason;
mod scan;

pub use crate::config::Names;
pub use file::Measured;
pub use gravimetric::{Gravimetric, GravimetricKeys, IntervalWord, Specimen};
pub use kinematics::{
    AlignWord, COLUMNS, CycleWord, Kinematics, KinematicsKeys, MeasuredCurve, Phase, Sample,
};
pub use reason::MeasuredReason;
pub use scan::{FitWord, Scan, ScanKeys};
