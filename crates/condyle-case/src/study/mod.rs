//! A study: a TOML file in, checked and typed values out.
//!
//! The file names a case, what of it varies and how, and what is asked. Its problems are reported as those of a case
//! are: all at once, each with a caret under its place.

mod alternative;
mod answers;
mod contents;
mod correlation;
mod count;
mod declared;
mod fingerprint;
mod input;
mod read;
mod reason;
mod rows;
mod tried;

pub use alternative::Alternative;
pub use answers::{Answers, Bound};
pub use contents::Study;
pub use correlation::Correlation;
pub use declared::{
    CorrelationKeys, Design, FactorialKeys, LevelKeys, MorrisKeys, NormalKeys, OptimiseKeys,
    RowsKeys, SampleKeys, TriangularKeys, TruncatedKeys, UniformKeys, Variation,
};
pub use input::Input;
pub use reason::StudyReason;
