//! What a march must remember.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{
    CreepState, CycleRecord, DepthField, DepthFields, NodeFields, UpdateRecord,
    accumulated_error::AccumulatedError, activity_wear::ActivityWear,
    comparison_laws::ComparisonLaw, step::StepRecord,
};
use crate::{
    Vec3,
    contact::{ContactState, CycleHistory, UnderSurface},
    geometry::Insert,
    machine::{Cycle, MachineState, SolverCounters, WarmStart},
};

/// Parts of the cycles at which two values stand for all: the mean of a cubic polynomial is that
/// of its values here, (1 -+ 1/sqrt 3) / 2 (Gauss's rule of two points).
pub const SNAPSHOT_PARTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// A step on the way, and what it began with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Which of the updates it led to, from 0.
    pub update: usize,
    /// The step.
    pub step: StepRecord,
    /// Nodes of the mesh before it.
    pub mesh_nodes: Vec<Vec3>,
    /// Depth of the surface before it.
    pub depths: DepthFields,
    /// The history of the contact before it.
    pub contact: ContactState,
    /// The machine of every activity at the end of its cycle.
    pub machines: Vec<MachineState>,
}

impl Snapshot {
    /// The same of the insert of its test with the surface lower by `down_mm` at every node, where that is not
    /// negative, and else higher.
    pub fn lowered(&self, unworn: &Insert, down_mm: Vec<f64>) -> Self {
        let mut insert = unworn.clone();
        insert.restore(self.mesh_nodes.clone(), &self.depths.total_mm());
        self.worn_on(insert, self.depths.clone(), down_mm)
    }

    /// The same on another insert, which is lowered from unworn by `down_mm` at once.
    pub fn on(&self, unworn: &Insert, down_mm: Vec<f64>) -> Self {
        let depths = DepthFields::none(down_mm.len());
        self.worn_on(unworn.clone(), depths, down_mm)
    }

    fn worn_on(&self, mut insert: Insert, mut depths: DepthFields, down_mm: Vec<f64>) -> Self {
        insert.wear_down(&insert.surface(), &down_mm);
        depths.add(&[DepthField::wear(down_mm)]);
        Self {
            mesh_nodes: insert.mesh().nodes.clone(),
            depths,
            contact: ContactState::default(),
            ..self.clone()
        }
    }
}

/// The machine of an activity, and what it did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActivityState {
    /// The machine at the end of the last cycle.
    pub machine: MachineState,
    /// How the increments of the last cycle were solved.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// The first cycle and the last one solved.
    pub first_and_last: Option<(CycleRecord, CycleRecord)>,
    /// What it has worn; nothing yet where it is the only one, since then it wears all.
    pub wear: ActivityWear,
}

impl ActivityState {
    /// A machine that has not run yet.
    pub(super) fn before(machine: MachineState) -> Self {
        Self {
            machine,
            warm_starts: Vec::new(),
            first_and_last: None,
            wear: ActivityWear::default(),
        }
    }

    /// Keeps a cycle as the last one, and as the first one too if it is; returns the history and its instants.
    pub(super) fn keep(&mut self, cycles: f64, cycle: Cycle) -> (CycleHistory, Vec<Range<usize>>) {
        self.machine = cycle.end;
        self.warm_starts = cycle.warm_starts;
        let last = CycleRecord {
            cycles,
            rows: cycle.rows,
        };
        let first = self.first_and_last.take().map(|(first, _)| first);
        self.first_and_last = Some((first.unwrap_or_else(|| last.clone()), last));
        (cycle.history, cycle.instants)
    }
}

/// All that a march must remember to go on from an update, to the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MarchState {
    /// Results of the updates done.
    pub updates: Vec<UpdateRecord>,
    /// What the last of them found at every node of the surface; none before the first.
    pub fields: Option<NodeFields>,
    /// Highest pressure of the first cycle at every node of the surface, MPa; none before the first update.
    pub first_pressure_mpa: Vec<f64>,
    /// Nodes of the mesh as worn.
    pub mesh_nodes: Vec<Vec3>,
    /// How deep the surface has gone down, and by what.
    pub depths: DepthFields,
    /// What creep remembers of the load.
    pub creep: CreepState,
    /// What of the volume worn is outside of what the wear law was fitted to, mm3; none where that is not
    /// known.
    pub outside_mm3: Option<f64>,
    /// What the laws beside it would have worn.
    pub comparison_laws: Vec<ComparisonLaw>,
    /// The history of the contact.
    pub contact: ContactState,
    /// What is below the surface at the increment of the last update with the highest pressure, if the insert is a
    /// solid.
    pub under_surface: Option<UnderSurface>,
    /// One an activity.
    pub activities: Vec<ActivityState>,
    /// Where the femoral frame's origin is in the insert frame at neutral, mm.
    pub zero_mm: Vec3,
    /// Positions of the joints at neutral, mm and rad: 0 but for those that settling does not zero. All
    /// are 0 in a march from a snapshot, which did not settle.
    pub settled: [f64; 6],
    /// Work done.
    pub counters: SolverCounters,
    /// The first step, on the unworn insert, and the machines at the end of its cycles.
    pub first_step: Option<(StepRecord, Vec<MachineState>)>,
    /// The last steps that began before each of [`SNAPSHOT_PARTS`]; none before the first.
    pub snapshots: [Option<Snapshot>; 2],
    /// The step before, which the next one is extrapolated from.
    pub last_step: Option<StepRecord>,
    /// What the steps but the last have cost in accuracy.
    pub settled_error: AccumulatedError,
    /// What all steps have cost in accuracy, that of the last predicted.
    pub step_error: AccumulatedError,
}

impl MarchState {
    /// Before the first update.
    pub(super) fn before(
        mesh_nodes: Vec<Vec3>,
        depths: DepthFields,
        contact: ContactState,
        machines: impl IntoIterator<Item = MachineState>,
        zero_mm: Vec3,
    ) -> Self {
        Self {
            updates: Vec::new(),
            fields: None,
            first_pressure_mpa: Vec::new(),
            mesh_nodes,
            depths,
            creep: CreepState::default(),
            outside_mm3: Some(0.0),
            comparison_laws: Vec::new(),
            contact,
            under_surface: None,
            activities: machines.into_iter().map(ActivityState::before).collect(),
            zero_mm,
            settled: [0.0; 6],
            counters: SolverCounters::default(),
            first_step: None,
            snapshots: [None, None],
            last_step: None,
            settled_error: AccumulatedError::default(),
            step_error: AccumulatedError::default(),
        }
    }

    /// Cycles done before an update, from 0.
    pub fn cycles_before(&self, update: usize) -> f64 {
        let before = update.checked_sub(1);
        before.map_or(0.0, |before| self.updates[before].cycles)
    }

    /// Remembers a step that began when this part of the cycles was done.
    pub(super) fn pass(&mut self, part: f64, snapshot: Snapshot) {
        if self.first_step.is_none() {
            self.first_step = Some((snapshot.step.clone(), snapshot.machines.clone()));
        }
        self.last_step = Some(snapshot.step.clone());
        let [early, late] = SNAPSHOT_PARTS;
        if part <= early {
            self.snapshots[0] = Some(snapshot.clone());
        }
        if part <= late {
            self.snapshots[1] = Some(snapshot);
        }
    }
}
