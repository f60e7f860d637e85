//! What a march must remember.

use serde::{Deserialize, Serialize};

use super::{CycleRecord, StepError, UpdateRecord, step::StepRecord};
use crate::{
    Vec3,
    machine::{MachineState, SolverCounters, WarmStart},
};

/// Parts of the cycles at which two values stand for all: the mean of a cubic polynomial is that
/// of its values here, (1 -+ 1/sqrt 3) / 2 (Gauss's rule of two points).
pub const SNAPSHOT_PARTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// A step on the way, and the insert and the motion that it began with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The step.
    pub step: StepRecord,
    /// Nodes of the mesh before it.
    pub mesh_nodes: Vec<Vec3>,
    /// Depth worn at each surface node before it, mm.
    pub worn_mm: Vec<f64>,
    /// The machine at the end of its cycle.
    pub machine: MachineState,
}

/// All that a march must remember to go on from an update, to the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MarchState {
    /// Results of the updates done.
    pub updates: Vec<UpdateRecord>,
    /// Nodes of the mesh as worn.
    pub mesh_nodes: Vec<Vec3>,
    /// Depth worn at each surface node, mm.
    pub worn_mm: Vec<f64>,
    /// The machine at the end of the last cycle.
    pub machine: MachineState,
    /// How the increments of the last cycle were solved.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// Where the femoral frame's origin is in the insert frame at neutral, mm.
    pub zero_mm: Vec3,
    /// Work done.
    pub counters: SolverCounters,
    /// The first cycle and the last one solved.
    pub first_and_last: Option<(CycleRecord, CycleRecord)>,
    /// The first step, on the unworn insert, and the machine at the end of its cycle.
    pub first_step: Option<(StepRecord, MachineState)>,
    /// The last steps that began before each of [`SNAPSHOT_PARTS`]; none before the first.
    pub snapshots: [Option<Snapshot>; 2],
    /// The step before, which the next one is extrapolated from.
    pub last_step: Option<StepRecord>,
    /// What the steps but the last have cost in accuracy.
    pub settled_error: StepError,
    /// What all steps have cost in accuracy, that of the last foreseen.
    pub step_error: StepError,
}

impl MarchState {
    /// Remembers a step that began when this part of the cycles was done.
    pub(super) fn pass(&mut self, part: f64, snapshot: Snapshot) {
        if self.first_step.is_none() {
            self.first_step = Some((snapshot.step.clone(), snapshot.machine));
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

    /// Before the first update, on an insert worn by `worn_mm`.
    pub(super) fn at(
        mesh_nodes: Vec<Vec3>,
        worn_mm: Vec<f64>,
        machine: MachineState,
        zero_mm: Vec3,
    ) -> Self {
        Self {
            updates: Vec::new(),
            mesh_nodes,
            worn_mm,
            machine,
            warm_starts: Vec::new(),
            zero_mm,
            counters: SolverCounters::default(),
            first_and_last: None,
            first_step: None,
            snapshots: [None, None],
            last_step: None,
            settled_error: StepError::default(),
            step_error: StepError::default(),
        }
    }
}
