//! Results of an update at every node of the articulating surface.

use serde::{Deserialize, Serialize};

use super::{Activity, DepthFields, rates::Rates};
use crate::{contact::CycleHistory, geometry::Insert};

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
            sliding_distance_mm: none,
            thickness_mm: insert.thickness_mm().to_vec(),
        }
    }

    /// Those of an insert after a step by one solved cycle of every activity.
    pub(super) fn of(
        cycles: &[(&Activity, &CycleHistory)],
        rates: &Rates,
        insert: &Insert,
        depths: &DepthFields,
    ) -> Self {
        let nodes = 0..insert.surface_nodes().len();
        let highest = |node| {
            let pressures = cycles.iter().map(|(_, of)| of.node(node).peak_pressure_mpa);
            pressures.fold(0.0, f64::max)
        };
        let slid = |node| -> f64 {
            let slid = |(activity, of): &(&Activity, &CycleHistory)| {
                activity.share * of.node(node).pressed_area_slip_mm3 / rates.area_mm2[node]
            };
            cycles.iter().map(slid).sum()
        };
        Self {
            wear_depth_mm: depths.wear_mm().to_vec(),
            depth_per_cycle_mm: rates.depth_per_cycle_mm.clone(),
            peak_pressure_mpa: nodes.clone().map(highest).collect(),
            sliding_distance_mm: nodes.map(slid).collect(),
            thickness_mm: insert.thickness_mm().to_vec(),
        }
    }
}
