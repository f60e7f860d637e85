//! Measured data to hold a run against: a TOML file in, checked and typed data out.
//!
//! The file names any of three: kinematics, gravimetric wear, and a scan of the worn surface. Its
//! problems are reported as those of a case are: all at once, each with a caret under its place.

mod checks;
mod declared;
mod gravimetric;
mod kinematics;
#[cfg(feature = "file-system")]
mod on_disk;
mod phases;
mod read;
mod reason;
mod scan;

pub use crate::config::Names;
pub use declared::{
    AlignWord, CycleWord, FitWord, GravimetricKeys, IntervalWord, KinematicsKeys, ScanKeys,
};
pub use gravimetric::{Gravimetric, Specimen};
pub use kinematics::{COLUMNS, Kinematics, MeasuredCurve, Sample};
pub use phases::Phase;
pub use read::Measured;
pub use reason::MeasuredReason;
pub use scan::Scan;
