//! What a march tells of itself.

use serde::{Deserialize, Serialize};

use super::{WearTest, rates::Rates};
use crate::machine::{Cycle, CycleRow};

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
    /// Volume worn so far, from the change of the mesh, mm3.
    pub volume_loss_mesh_mm3: f64,
    /// Mass worn so far, mg.
    pub mass_loss_mg: f64,
    /// Deepest wear so far, mm.
    pub max_depth_mm: f64,
    /// Highest pressure of its cycle anywhere, between nodes too, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest area of its cycle, mm2.
    pub peak_contact_area_mm2: f64,
    /// Cycles solved until one repeated itself.
    pub cycles_solved: f64,
    /// Whether one did.
    pub repeats: bool,
    /// Smallest scaled Jacobian of the worn mesh.
    pub worst_quality: f64,
}

/// The motions and loads of one solved cycle, and how many cycles of wear it came after.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRecord {
    /// Cycles done before it.
    pub cycles: f64,
    /// One row an increment.
    pub rows: Vec<CycleRow>,
}

/// Results of an update at every node of the articulating surface.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeFields {
    /// Depth worn so far, mm.
    pub wear_depth_mm: Vec<f64>,
    /// Depth one cycle wears, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Highest pressure of the cycle, the mean over the node's share, MPa.
    pub peak_pressure_mpa: Vec<f64>,
    /// Distance slid under pressure in the cycle, mm.
    pub sliding_distance_mm: Vec<f64>,
    /// Thickness left, mm.
    pub thickness_mm: Vec<f64>,
}

impl NodeFields {
    /// Those of an insert that no cycle has worn in this march.
    pub(super) fn unworn(test: &WearTest, worn_mm: &[f64]) -> Self {
        let none = vec![0.0; worn_mm.len()];
        Self {
            wear_depth_mm: worn_mm.to_vec(),
            depth_per_cycle_mm: none.clone(),
            peak_pressure_mpa: none.clone(),
            sliding_distance_mm: none,
            thickness_mm: test.insert.thickness_mm().to_vec(),
        }
    }

    /// Those after a step by a solved cycle.
    pub(super) fn of(cycle: &Cycle, rates: &Rates, worn_mm: &[f64], thickness_mm: &[f64]) -> Self {
        let nodes = || (0..cycle.history.node_count()).map(|node| cycle.history.node(node));
        Self {
            wear_depth_mm: worn_mm.to_vec(),
            depth_per_cycle_mm: rates.depth_per_cycle_mm.clone(),
            peak_pressure_mpa: nodes().map(|node| node.peak_pressure_mpa).collect(),
            sliding_distance_mm: nodes().map(|node| node.sliding_distance_mm).collect(),
            thickness_mm: thickness_mm.to_vec(),
        }
    }
}
