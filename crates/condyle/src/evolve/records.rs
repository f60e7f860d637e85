//! What a march tells of itself.

use serde::{Deserialize, Serialize};

use super::{CreepRecord, UnderSurfaceRecord};
use crate::machine::CycleRow;

/// How far a march has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Which update, from 1.
    pub update: usize,
    /// Cycles solved for it; the last of them counts once it repeats itself.
    pub cycles_solved: f64,
    /// Cycles of the test done, the part of the present interval that is solved included.
    pub cycles: f64,
}

/// What one update found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UpdateRecord {
    /// Cycles done after it.
    pub cycles: f64,
    /// Volume worn so far, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Volume worn so far, from the change of the mesh less the volume of creep, mm3.
    pub volume_loss_mesh_mm3: f64,
    /// Mass worn so far, mg.
    pub mass_loss_mg: f64,
    /// Deepest wear so far, mm.
    pub max_depth_mm: f64,
    /// Highest pressure of its cycles anywhere, between nodes too, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest contact area of its cycles, mm2.
    pub peak_contact_area_mm2: f64,
    /// Cycles solved until one of every activity repeated itself.
    pub cycles_solved: f64,
    /// Whether all did.
    pub repeats: bool,
    /// Smallest scaled Jacobian of the worn mesh.
    pub worst_quality: f64,
    /// Creep so far, if the insert creeps.
    pub creep: Option<CreepRecord>,
    /// What is below the surface where the pressure is highest, if the insert is a solid.
    pub under_surface: Option<UnderSurfaceRecord>,
}

/// The motions and loads of one solved cycle, and how many cycles of wear it came after.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRecord {
    /// Cycles done before it.
    pub cycles: f64,
    /// One row an increment.
    pub rows: Vec<CycleRow>,
}
