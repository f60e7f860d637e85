//! When and from what results were made.

use serde::Serialize;

/// When and from what the results were made.
#[derive(Clone, Debug, Serialize)]
pub struct Stamp {
    /// Commit of the source.
    pub commit: String,
    /// Date of the run.
    pub date: String,
}
