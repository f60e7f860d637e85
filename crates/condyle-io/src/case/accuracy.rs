//! What a run tells of its own accuracy.

use crate::config::settings;

settings! {
    /// What a run tells of its own accuracy.
    Accuracy {
        /// Whether discretisation errors are estimated after the run, by solving the unworn cycle more coarsely.
        estimate: bool = true;
    }
}
