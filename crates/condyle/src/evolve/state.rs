//! What a march must remember.

use serde::{Deserialize, Serialize};

use super::{CycleRecord, StepError, UpdateRecord, step::StepRecord};
use crate::{
    Vec3,
    machine::{Effort, MachineState},
};

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
    /// Where the femoral frame's origin is in the insert frame at neutral, mm.
    pub zero_mm: Vec3,
    /// Work done.
    pub effort: Effort,
    /// The first cycle and the last one solved.
    pub first_and_last: Option<(CycleRecord, CycleRecord)>,
    /// The first step, on the unworn insert.
    pub first_step: Option<StepRecord>,
    /// The machine at the end of the first cycle that repeated itself.
    pub first_cycle_end: Option<MachineState>,
    /// The step before, which the next one is extrapolated from.
    pub last_step: Option<StepRecord>,
    /// What the steps but the last have cost in accuracy.
    pub settled_error: StepError,
    /// What all steps have cost in accuracy, that of the last foreseen.
    pub step_error: StepError,
}
