//! A study: a TOML file in, checked and typed values out.
//!
//! The file names a case, its varied keys, the design of the tests, and the questions. All its problems are reported at
//! once, each with a caret under its place, as those of a case are.

mod answers;
mod contents;
mod declared;
mod input;
mod outputs;
mod read;

pub use answers::{Answers, Bound};
pub use contents::{Aim, Alternative, Correlation, Study};
pub use declared::{
    AdaptiveKeys, BetaKeys, CorrelationKeys, Design, EmpiricalKeys, FactorialKeys, LevelKeys,
    LognormalKeys, MorrisKeys, NormalKeys, OptimiseKeys, RowsKeys, SampleKeys, TriangularKeys,
    TruncatedKeys, UniformKeys, Variation, WeibullKeys,
};
pub use input::{Input, ScaledKey};
pub use outputs::Outputs;
