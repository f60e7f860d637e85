//! The solution of one repeating cycle of every activity, from which the wear of an update is computed.

use std::ops::ControlFlow;

use super::{
    Activity, CyclePeaks, MarchError, MarchState, Progress, UnderSurfaceRecord, Updates, WearTest,
    next_step::{equal_interval, fixed_interval},
};
use crate::{
    contact::{ContactMemory, ContactModel, CycleHistory, Moment},
    geometry::ArticulatingSurface,
    machine::{Chain, Cycle, CycleRow, Simulator, SolverCounters},
    spatial::Pose,
    wear::SharedCycle,
};

/// Factor on the tolerances of the repetition for the first cycle, that of the last update and the final one, whose motions
/// or sums are results. The others matter by their wear alone, whose error is a hundred times smaller than that of the motions.
const REPORTED: f64 = 0.1;
/// An update that will reach this part of the cycles is the last: the sum of the intervals is rounded.
const LAST: f64 = 1.0 - 1e-9;

/// The last solved cycle of an activity, and the surface that it loaded.
///
/// The wear of an update is computed from it, on the surface before that wear; the final cycle wears nothing.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct SolvedCycle<'a> {
    /// One row per increment.
    pub rows: &'a [CycleRow],
    /// The articulating surface that it loaded.
    pub surface: &'a ArticulatingSurface,
    pub(super) chain: &'a Chain,
    pub(super) cycle: &'a Cycle,
}

impl SolvedCycle<'_> {
    /// Returns the pose of the counterface in the insert frame at the end of an increment.
    pub fn pose(&self, increment: usize) -> Pose {
        self.chain.at(&self.rows[increment].positions).pose
    }

    /// Returns pressure and slip of a surface node in an increment, or `None` where it was not touched.
    pub fn moment(&self, increment: usize, node: usize) -> Option<&Moment> {
        let touched = self.cycle.history.instant(&self.cycle.instants[increment]);
        let own = touched.iter().find(|record| record.node as usize == node);
        own.map(|record| &record.moment)
    }

    /// Returns the pressure at every surface node at the end of an increment, the mean over the node's
    /// share, MPa.
    pub fn pressures_mpa(&self, increment: usize) -> Vec<f64> {
        let mut pressures_mpa = vec![0.0; self.surface.positions.len()];
        for record in self.cycle.history.instant(&self.cycle.instants[increment]) {
            pressures_mpa[record.node as usize] = record.moment.pressure_mpa;
        }
        pressures_mpa
    }
}

/// One solved cycle of every activity, and the surface that it loaded. The next cycles reuse the memory of its histories.
pub(super) struct SolvedCycles {
    pub surface: ArticulatingSurface,
    pub cycles: Vec<Cycle>,
    pub counters: SolverCounters,
    /// The memory of the contact after them.
    pub memory: ContactMemory,
}

/// Solves one repeating cycle of every activity with the geometry fixed, all on the same contact.
///
/// `spent` are histories whose memory is reused.
pub(super) fn solve(
    test: &WearTest,
    state: &MarchState,
    chains: &[Chain],
    contact: &mut dyn ContactModel,
    mut spent: Vec<CycleHistory>,
    watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<ControlFlow<(), (Vec<Cycle>, SolverCounters)>, MarchError> {
    let activities = &test.activities;
    let done = state.cycles();
    let left = test.schedule.cycles - done;
    let update = state.update_in_progress(left);
    let interval = likely_interval(test, state).min(left);
    let is_reported = state.updates.is_empty() || done + interval >= LAST * test.schedule.cycles;
    let mut time = test.time;
    if is_reported {
        time.repeat_tolerance_mm *= REPORTED;
        time.repeat_tolerance_rad *= REPORTED;
    }
    spent.resize_with(activities.len(), CycleHistory::default);
    let mut counters = state.counters;
    let mut cycles = Vec::with_capacity(activities.len());
    for (number, (activity, spent)) in activities.iter().zip(spent).enumerate() {
        let own = &state.activities[number];
        let mut simulator = Simulator::new(&activity.machine, &chains[number], contact, &time);
        simulator.counters = counters;
        simulator.warm_starts.clone_from(&own.warm_starts);
        // Histories are large; reusing their memory avoids an allocation per update.
        simulator.history = spent;
        let mut watch_cycle = |solved| {
            let cycles_solved = solved as f64 / time.increments as f64;
            let part = (number as f64 + cycles_solved.min(1.0)) / activities.len() as f64;
            watch(Progress {
                update,
                cycles_solved,
                cycles: done + interval * part,
            })
        };
        let solved = simulator.cycle(&own.machine, &mut watch_cycle);
        counters = simulator.counters;
        let not_solved = |source| MarchError::Cycle {
            update,
            cycles: done,
            activity: (activities.len() > 1).then(|| activity.name.clone()),
            source,
        };
        match solved.map_err(not_solved)? {
            ControlFlow::Continue(cycle) => cycles.push(cycle),
            ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
        }
    }
    Ok(ControlFlow::Continue((cycles, counters)))
}

/// Estimates the number of cycles of the next step.
fn likely_interval(test: &WearTest, state: &MarchState) -> f64 {
    let schedule = &test.schedule;
    match schedule.updates {
        Updates::Fixed(updates) => {
            let (done, creeps) = (state.updates.len(), test.creep.is_some());
            fixed_interval(schedule.cycles, updates, done, creeps)
        }
        Updates::Auto { .. } => {
            let left = schedule.cycles - state.cycles();
            let last = state.last_step.as_ref();
            last.map_or(0.0, |last| equal_interval(left, last.interval))
        }
    }
}

impl SolvedCycles {
    pub fn touch(&self) -> bool {
        let mut rows = self.cycles.iter().flat_map(|cycle| &cycle.rows);
        // Exactly zero: a row without touched nodes is a sum of nothing.
        rows.any(|row| row.axial_force_n != 0.0)
    }

    /// Returns the history of every activity's cycle with the activity's share.
    pub fn with_shares(&self, activities: &[Activity]) -> Vec<SharedCycle<'_>> {
        let histories = self.cycles.iter().map(|cycle| &cycle.history);
        let shares = activities.iter().map(|activity| activity.share);
        shares.zip(histories).collect()
    }

    /// Returns the extremes of all rows, with the stress `under_surface`.
    pub fn peaks(&self, under_surface: Option<UnderSurfaceRecord>) -> CyclePeaks {
        let largest = |value: fn(&CycleRow) -> f64| {
            let each = self.cycles.iter().map(|cycle| cycle.max(value));
            each.fold(0.0, f64::max)
        };
        CyclePeaks {
            peak_pressure_mpa: largest(|row| row.peak_pressure_mpa),
            contact_area_mm2: largest(|row| row.contact_area_mm2),
            under_surface,
        }
    }

    /// Returns the activity and the row with the highest pressure; the first of several.
    pub fn highest_pressure(&self) -> Option<(usize, usize)> {
        let cycles = self.cycles.iter().enumerate();
        let rows = cycles.flat_map(|(activity, cycle)| {
            let rows = cycle.rows.iter().enumerate();
            rows.map(move |(row, own)| ((activity, row), own.peak_pressure_mpa))
        });
        let higher = |most: ((usize, usize), f64), next: ((usize, usize), f64)| {
            if next.1 > most.1 { next } else { most }
        };
        rows.reduce(higher).map(|(place, _)| place)
    }

    /// Returns the load on every node touched in a row of an activity's cycle, N.
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
