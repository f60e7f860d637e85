//! The cycle that a march solved last, increment by increment.

use std::ops::Range;

use crate::{
    contact::{CycleHistory, Moment},
    geometry::ArticulatingSurface,
    machine::{Chain, CycleRow},
    spatial::Pose,
};

/// The last solved cycle of an activity, and the surface that it pressed on.
///
/// It is what the wear of an update was computed from: the surface is the one before that wear.
#[derive(Clone, Copy)]
pub struct SolvedCycle<'a> {
    /// A row an increment.
    pub rows: &'a [CycleRow],
    /// The articulating surface that it pressed on.
    pub surface: &'a ArticulatingSurface,
    pub(super) chain: &'a Chain,
    pub(super) history: &'a CycleHistory,
    /// Where the moments of each increment are recorded.
    pub(super) instants: &'a [Range<usize>],
}

impl SolvedCycle<'_> {
    /// Where the femur is in the insert frame at the end of increment number `increment`.
    pub fn pose(&self, increment: usize) -> Pose {
        self.chain.at(&self.rows[increment].positions).pose
    }

    /// Pressure and slip of a node of the surface in increment number `increment`; none where it was not touched.
    pub fn moment(&self, increment: usize, node: usize) -> Option<&Moment> {
        let touched = self.history.instant(&self.instants[increment]);
        let own = touched.iter().find(|record| record.node as usize == node);
        own.map(|record| &record.moment)
    }

    /// Pressure at every node of the surface at the end of increment number `increment`, the mean
    /// over its share, MPa.
    pub fn pressures_mpa(&self, increment: usize) -> Vec<f64> {
        let mut pressures_mpa = vec![0.0; self.surface.positions.len()];
        for record in self.history.instant(&self.instants[increment]) {
            pressures_mpa[record.node as usize] = record.moment.pressure_mpa;
        }
        pressures_mpa
    }
}
