//! How much work the solver does.

use serde::{Deserialize, Serialize};

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverCounters {
    /// Newton iterations: corrections of the positions.
    pub newton_iterations: u64,
    /// Contact evaluations, each with its tangent but for explicit steps.
    pub contact_evaluations: u64,
    /// Steps given up and tried in halves.
    pub halvings: u64,
    /// Explicit steps.
    pub explicit_steps: u64,
    /// Most inertia that explicit steps added, as a part of the machine's own.
    pub added_inertia: f64,
}
