//! Measured data to hold a run against: a TOML file in, checked and typed data out.
//!
//! The file names any of three: kinematics, gravimetric wear, and a scan of the worn surface. Its
//! problems are reported as those of a case are: all at once, each with a caret under its place.

mod file;
mod gravimetric;
mod kinematics;
mod reason;
mod scan;

pub use crate::config::Names;
pub use file::{
    AlignWord, CycleWord, FitWord, GravimetricKeys, IntervalWord, KinematicsKeys, Measured,
    ScanKeys,
};
pub use gravimetric::{Gravimetric, Specimen};
pub use kinematics::{COLUMNS, Kinematics, MeasuredCurve, Phase, Sample};
pub use reason::MeasuredReason;
pub use scan::Scan;
