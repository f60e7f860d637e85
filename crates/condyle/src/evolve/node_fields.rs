//! Results of an update at every node of the articulating surface.

use serde::{Deserialize, Serialize};

use super::{DepthFields, rates::Rates};
use crate::{
    geometry::{ArticulatingSurface, Insert},
    wear::MeanCycle,
};

/// Results of an update at every node of the articulating surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeFields {
    /// Depth worn so far, mm.
    pub wear_depth_mm: Vec<f64>,
    /// Depth one cycle wears, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Highest pressure of the cycles, the mean over the node's share, MPa.
    pub peak_pressure_mpa: Vec<f64>,
    /// Distance slid under pressure in a cycle, mm: S = sum of A'/A |ds|, with A' the part of the
    /// node's share A that presses; the mean over all activities by their shares.
    pub sliding_distance_mm: Vec<f64>,
    /// Cross-shear ratio of the mean cycle: what of pressure times slip is across the principal direction, 0
    /// for straight paths to 0.5.
    pub cross_shear: Vec<f64>,
    /// The principal direction, a unit vector along the surface in the insert frame that points anteriorly; 0
    /// where nothing slid, or as much in every direction.
    pub principal_direction: Vec<[f64; 3]>,
    /// Thickness left, mm.
    pub thickness_mm: Vec<f64>,
}

impl NodeFields {
    /// Those of an insert that no cycle has worn in this march.
    pub(super) fn unworn(insert: &Insert, depths: &DepthFields) -> Self {
        let none = vec![0.0; insert.surface_nodes().len()];
        Self {
            wear_depth_mm: depths.wear_mm().to_vec(),
            depth_per_cycle_mm: none.clone(),
            peak_pressure_mpa: none.clone(),
            sliding_distance_mm: none.clone(),
            principal_direction: vec![[0.0; 3]; none.len()],
            cross_shear: none,
            thickness_mm: insert.thickness_mm().to_vec(),
        }
    }

    /// Those of an insert after a step by cycles on `surface`.
    pub(super) fn of(
        cycles: &[MeanCycle<'_>],
        surface: &ArticulatingSurface,
        rates: &Rates,
        insert: &Insert,
        depths: &DepthFields,
    ) -> Self {
        let each = |value: fn(&MeanCycle<'_>) -> f64| cycles.iter().map(value).collect();
        let direction = |(node, cycle)| principal_direction(surface, node, cycle);
        Self {
            wear_depth_mm: depths.wear_mm().to_vec(),
            depth_per_cycle_mm: rates.depth_per_cycle_mm.clone(),
            peak_pressure_mpa: each(|cycle| cycle.peak_pressure_mpa),
            sliding_distance_mm: each(|cycle| cycle.pressed_distance_mm),
            cross_shear: each(|cycle| cycle.slip_work.cross_shear()),
            principal_direction: cycles.iter().enumerate().map(direction).collect(),
            thickness_mm: insert.thickness_mm().to_vec(),
        }
    }
}

/// The principal direction of a node in the insert frame.
fn principal_direction(
    surface: &ArticulatingSurface,
    node: usize,
    cycle: &MeanCycle<'_>,
) -> [f64; 3] {
    let Some([forwards, aside]) = cycle.slip_work.principal_direction() else {
        return [0.0; 3];
    };
    let [anterior, lateral] = surface.directions(node);
    (anterior * forwards + lateral * aside).into()
}
