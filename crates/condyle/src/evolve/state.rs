//! The state of a march, from which it resumes.

use serde::{Deserialize, Serialize};

use super::{
    AccumulatedError, ActivityWear, ComparisonLaw, CreepState, CyclePeaks, CycleRecord, Depths,
    FamilyWear, NodeFields, StepRecord, UpdateRecord,
};
use crate::{
    Vec3,
    contact::{ContactState, UnderSurface},
    geometry::Insert,
    machine::{Cycle, MachineState, SolverCounters, WarmStart},
};

/// Parts of the cycles whose values have the mean of the whole: exact for a cubic polynomial,
/// (1 -+ 1/sqrt 3) / 2 (Gauss's rule of two points).
pub const SNAPSHOT_PARTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// A step of the march and the state before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Number of the update that it led to, from 0.
    pub update: usize,
    /// The step.
    pub step: StepRecord,
    /// Nodes of the mesh before it.
    pub mesh_nodes: Vec<Vec3>,
    /// Depth of the surface before it.
    pub depths: Depths,
    /// The history of the contact before it.
    pub contact: ContactState,
    /// The machine of every activity at the end of its cycle.
    pub machines: Vec<MachineState>,
}

impl Snapshot {
    /// Returns the snapshot with the surface of the insert lowered by `down_mm` at every node; negative values raise it.
    pub fn lowered(&self, unworn: &Insert, down_mm: Vec<f64>) -> Self {
        let mut insert = unworn.clone();
        insert.restore(self.mesh_nodes.clone(), &self.depths.total_mm());
        self.worn_on(insert, self.depths.clone(), down_mm)
    }

    /// Returns the snapshot on another insert, lowered from unworn by `down_mm` at once.
    pub fn on(&self, unworn: &Insert, down_mm: Vec<f64>) -> Self {
        let depths = Depths::by_wear(vec![0.0; down_mm.len()]);
        self.worn_on(unworn.clone(), depths, down_mm)
    }

    fn worn_on(&self, mut insert: Insert, mut depths: Depths, down_mm: Vec<f64>) -> Self {
        insert.wear_down(&insert.surface(), &down_mm);
        depths.add(&Depths::by_wear(down_mm));
        Self {
            mesh_nodes: insert.mesh().nodes.clone(),
            depths,
            contact: ContactState::default(),
            ..self.clone()
        }
    }
}

/// The state of an activity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActivityState {
    /// The machine at the end of the last cycle.
    pub machine: MachineState,
    /// Solutions of the increments of the last cycle.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// The first cycle and the last one solved.
    pub first_and_last: Option<(CycleRecord, CycleRecord)>,
    /// Its wear; without volumes for a single activity, which causes all wear.
    pub wear: ActivityWear,
}

impl ActivityState {
    pub(super) fn before(machine: MachineState) -> Self {
        Self {
            machine,
            warm_starts: Vec::new(),
            first_and_last: None,
            wear: ActivityWear::default(),
        }
    }

    /// Keeps a cycle as the last one, and the first of all as the first.
    pub(super) fn keep(&mut self, cycles: f64, cycle: &Cycle) {
        self.machine = cycle.end;
        let wear = &mut self.wear;
        let pressure_mpa = cycle.max(|row| row.peak_pressure_mpa);
        wear.peak_pressure_mpa = wear.peak_pressure_mpa.max(pressure_mpa);
        let area_mm2 = cycle.max(|row| row.contact_area_mm2);
        wear.peak_contact_area_mm2 = wear.peak_contact_area_mm2.max(area_mm2);
        self.warm_starts.clone_from(&cycle.warm_starts);
        let rows = cycle.rows.clone();
        let last = CycleRecord { cycles, rows };
        let first = self.first_and_last.take().map(|(first, _)| first);
        self.first_and_last = Some((first.unwrap_or_else(|| last.clone()), last));
    }
}

/// The state of a march after an update, from which it continues to the same bytes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MarchState {
    /// Results of the updates done.
    pub updates: Vec<UpdateRecord>,
    /// Extremes of the cycle on the worn surface; none until all cycles are done.
    pub final_cycle: Option<CyclePeaks>,
    /// Results of the last solved cycle at every surface node; none before the first.
    pub fields: Option<NodeFields>,
    /// Highest pressure of the first cycle at every surface node, MPa; empty before the first update.
    pub first_pressure_mpa: Vec<f64>,
    /// Nodes of the mesh as worn.
    pub mesh_nodes: Vec<Vec3>,
    /// Depth of the surface.
    pub depths: Depths,
    /// The load history of creep.
    pub creep: CreepState,
    /// Part of the worn volume outside the range to which the wear law was fitted, mm3; none if that is unknown.
    pub outside_mm3: Option<f64>,
    /// The wear by the comparison laws.
    pub comparison_laws: Vec<ComparisonLaw>,
    /// The wear by every law of the power-law family; `None` unless the test requests it.
    pub law_family: Option<FamilyWear>,
    /// The history of the contact.
    pub contact: ContactState,
    /// Stress below the surface at the increment of the last solved cycle with the highest pressure, if the insert is
    /// a solid.
    pub under_surface: Option<UnderSurface>,
    /// One per activity.
    pub activities: Vec<ActivityState>,
    /// Position of the counterface frame's origin in the insert frame at neutral, mm.
    pub zero_mm: Vec3,
    /// Positions of the joints at neutral, mm and rad: 0 except for those that settling does not zero. All
    /// are 0 in a march from a snapshot, which did not settle.
    pub settled: [f64; 6],
    /// Counts of the work done.
    pub counters: SolverCounters,
    /// Increments of the cycles of the updates and of the final cycle.
    pub increments_solved: u64,
    /// Updates, and the final cycle, in which an activity did not repeat itself.
    pub not_repeating: u64,
    /// The first step, on the unworn insert, and the machines at the end of its cycles.
    pub first_step: Option<(StepRecord, Vec<MachineState>)>,
    /// The last steps that began before each of [`SNAPSHOT_PARTS`]; none before the first.
    pub snapshots: [Option<Snapshot>; 2],
    /// The last step, from which the next one is extrapolated.
    pub last_step: Option<StepRecord>,
    /// Error caused by the length of all steps except the last.
    pub settled_error: AccumulatedError,
    /// Error caused by the length of all steps, predicted for the last.
    pub step_error: AccumulatedError,
}

impl MarchState {
    pub(super) fn before(
        mesh_nodes: Vec<Vec3>,
        depths: Depths,
        contact: ContactState,
        machines: impl IntoIterator<Item = MachineState>,
        zero_mm: Vec3,
    ) -> Self {
        Self {
            mesh_nodes,
            depths,
            contact,
            zero_mm,
            outside_mm3: Some(0.0),
            activities: machines.into_iter().map(ActivityState::before).collect(),
            ..Self::default()
        }
    }

    pub(super) fn cycles(&self) -> f64 {
        self.updates.last().map_or(0.0, |last| last.cycles)
    }

    /// Returns the number of the update in progress, from 1, with `left` cycles to do: the final cycle, with none left, belongs to the last.
    pub(super) fn update_in_progress(&self, left: f64) -> usize {
        self.updates.len() + usize::from(left > 0.0)
    }

    /// Returns the cycles done before an update, numbered from 0.
    pub fn cycles_before(&self, update: usize) -> f64 {
        let before = update.checked_sub(1);
        before.map_or(0.0, |before| self.updates[before].cycles)
    }

    /// Keeps a step that began when this part of the cycles was done.
    pub(super) fn pass(&mut self, part: f64, snapshot: Snapshot) {
        if self.first_step.is_none() {
            self.first_step = Some((snapshot.step.clone(), snapshot.machines.clone()));
        }
        self.last_step = Some(snapshot.step.clone());
        let [early, late] = SNAPSHOT_PARTS;
        // A later step before the same part replaces the snapshot, so that the last one before it remains.
        if part <= early {
            self.snapshots[0] = Some(snapshot.clone());
        }
        if part <= late {
            self.snapshots[1] = Some(snapshot);
        }
    }
}
