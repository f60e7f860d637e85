//! Wear laws: one cycle's contact history in, depth per cycle out.

mod archard;

pub use archard::Archard;

use crate::contact::NodeHistory;

/// A law of wear. It sees what happened at one node through a whole cycle, and never a solver.
pub trait WearLaw: std::fmt::Debug + Send + Sync {
    /// Depth worn at a node by one cycle, mm, along the inward normal; 0 or more.
    fn depth_per_cycle_mm(&self, history: &NodeHistory<'_>) -> f64;
}
