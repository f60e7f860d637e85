//! What makes a finished run doubtful.

use serde::{Deserialize, Serialize};

/// A number of a run beyond what it may be if the run is to be believed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlausibilityWarning {
    /// Which check, a name that stays.
    pub check: String,
    /// What was found, in `unit`.
    pub value: f64,
    /// What it may be.
    pub limit: f64,
    /// Of value and limit; empty for a pure number.
    pub unit: String,
    /// What is doubtful, with the numbers, as a sentence.
    pub message: String,
    /// What to do, as a sentence.
    pub advice: String,
}
