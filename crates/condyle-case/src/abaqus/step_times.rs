//! How long the steps before the gait cycle last.

/// Length of the step SETTLE, s.
pub(super) const SETTLE_S: f64 = 0.3;
/// Length of the step START, s.
pub(super) const START_S: f64 = 0.2;
