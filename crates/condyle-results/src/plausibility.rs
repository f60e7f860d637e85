//! Reasons to doubt a finished run.

use serde::{Deserialize, Serialize};

/// A number of a run beyond the limit of plausible runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlausibilityWarning {
    /// The name of the check, the same in all versions.
    pub check: String,
    /// The value, in `unit`.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Unit of value and limit; empty for a pure number.
    pub unit: String,
    /// The doubt in a sentence with the numbers.
    pub message: String,
    /// The remedy in a sentence.
    pub advice: String,
}
