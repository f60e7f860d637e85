//! The solved cycles from which the wear of an update is computed.

use std::ops::Range;

use super::Activity;
use crate::{
    contact::{ContactMemory, CycleHistory, Moment},
    geometry::ArticulatingSurface,
    machine::{Chain, Cycle, CycleRow, SolverCounters},
    spatial::Pose,
    wear::SharedCycle,
};

/// The last solved cycle of an activity, and the surface that it pressed on.
///
/// The wear of an update is computed from it: the surface is the one before that wear.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct SolvedCycle<'a> {
    /// One row per increment.
    pub rows: &'a [CycleRow],
    /// The articulating surface that it pressed on.
    pub surface: &'a ArticulatingSurface,
    pub(super) chain: &'a Chain,
    pub(super) history: &'a CycleHistory,
    /// The moments of each increment in `history`.
    pub(super) instants: &'a [Range<usize>],
}

impl SolvedCycle<'_> {
    /// Returns the pose of the femur in the insert frame at the end of an increment.
    pub fn pose(&self, increment: usize) -> Pose {
        self.chain.at(&self.rows[increment].positions).pose
    }

    /// Returns pressure and slip of a surface node in an increment, or `None` where it was not touched.
    pub fn moment(&self, increment: usize, node: usize) -> Option<&Moment> {
        let touched = self.history.instant(&self.instants[increment]);
        let own = touched.iter().find(|record| record.node as usize == node);
        own.map(|record| &record.moment)
    }

    /// Returns the pressure at every surface node at the end of an increment, the mean over the node's
    /// share, MPa.
    pub fn pressures_mpa(&self, increment: usize) -> Vec<f64> {
        let mut pressures_mpa = vec![0.0; self.surface.positions.len()];
        for record in self.history.instant(&self.instants[increment]) {
            pressures_mpa[record.node as usize] = record.moment.pressure_mpa;
        }
        pressures_mpa
    }
}

/// One solved cycle of every activity, and the surface that it pressed on.
pub(super) struct SolvedCycles {
    pub surface: ArticulatingSurface,
    pub cycles: Vec<Cycle>,
    pub counters: SolverCounters,
    /// The memory of the contact after them.
    pub memory: ContactMemory,
}

impl SolvedCycles {
    /// Whether the bodies touch in any increment.
    pub fn touch(&self) -> bool {
        let mut rows = self.cycles.iter().flat_map(|cycle| &cycle.rows);
        rows.any(|row| row.axial_force_n != 0.0)
    }

    /// The history of every activity's cycle with the activity's share.
    pub fn with_shares(&self, activities: &[Activity]) -> Vec<SharedCycle<'_>> {
        let histories = self.cycles.iter().map(|cycle| &cycle.history);
        let shares = activities.iter().map(|activity| activity.share);
        shares.zip(histories).collect()
    }

    /// The largest value of any row; 0 if all are negative.
    pub fn max(&self, value: fn(&CycleRow) -> f64) -> f64 {
        let each = self.cycles.iter().map(|cycle| cycle.max(value));
        each.fold(0.0, f64::max)
    }

    /// The activity and the row with the highest pressure; the first of several.
    pub fn highest_pressure(&self) -> Option<(usize, usize)> {
        let rows = self
            .cycles
            .iter()
            .enumerate()
            .flat_map(|(activity, cycle)| {
                let rows = cycle.rows.iter().enumerate();
                rows.map(move |(row, own)| ((activity, row), own.peak_pressure_mpa))
            });
        let higher = |most: ((usize, usize), f64), next: ((usize, usize), f64)| {
            if next.1 > most.1 { next } else { most }
        };
        rows.reduce(higher).map(|(place, _)| place)
    }

    /// The load on every node touched in a row of an activity's cycle, N.
    pub fn loads_n(&self, activity: usize, row: usize) -> Vec<(u32, f64)> {
        let cycle = &self.cycles[activity];
        let touched = cycle.history.instant(&cycle.instants[row]).iter();
        touched
            .map(|record| {
                let area_mm2 = self.surface.shares[record.node as usize].area_mm2;
                (record.node, record.moment.pressure_mpa * area_mm2)
            })
            .collect()
    }
}
