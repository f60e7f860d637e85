//! What a cycle wears, and how soon wear changes that.

use super::mean_over_wear::{mean_over_volume, volume_mm3};
use crate::{
    contact::ContactLaw,
    geometry::{ArticulatingSurface, Insert},
    wear::{MeanCycle, NodeWear},
};

/// What a cycle wears on the present geometry, the mean over all activities by their shares.
#[derive(Clone, Debug)]
pub(super) struct Rates {
    /// Depth at every surface node, mm a cycle.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Area of every node's share of the surface, mm2.
    pub area_mm2: Vec<f64>,
    /// How fast the pressure at every node falls as the node alone wears, a cycle.
    pub node_relaxation_per_cycle: Vec<f64>,
    /// The mean of that over the worn volume: how fast wear flattens the pressure, a cycle.
    pub relaxation_per_cycle: f64,
}

/// The law of contact and the bodies that cycles wear.
pub(super) struct Wearing<'a> {
    pub contact: &'a dyn ContactLaw,
    pub insert: &'a Insert,
    pub surface: &'a ArticulatingSurface,
}

impl Rates {
    /// Those of nodes that go through these cycles, which wear them so.
    pub fn of(wearing: &Wearing<'_>, cycles: &[MeanCycle<'_>], worn: &[NodeWear]) -> Self {
        let depth_per_cycle_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
        let shares = wearing.surface.shares.iter();
        let area_mm2: Vec<f64> = shares.map(|share| share.area_mm2).collect();
        let alone = |node: usize| {
            let stiffness = wearing.contact.stiffness_mpa_per_mm(wearing.insert, node);
            relaxation(depth_per_cycle_mm[node], stiffness, &cycles[node])
        };
        let node_relaxation_per_cycle: Vec<f64> = (0..cycles.len()).map(alone).collect();
        let relaxation_per_cycle =
            mean_over_volume(&area_mm2, &depth_per_cycle_mm, &node_relaxation_per_cycle);
        Self {
            depth_per_cycle_mm,
            area_mm2,
            node_relaxation_per_cycle,
            relaxation_per_cycle,
        }
    }

    /// Volume worn by a cycle, mm3.
    pub fn volume_per_cycle_mm3(&self) -> f64 {
        volume_mm3(&self.area_mm2, &self.depth_per_cycle_mm)
    }
}

/// How fast a node's pressure falls as the node alone wears, a cycle: rate times the pressure
/// that a millimetre of depth takes away, over the mean pressure while it slides.
fn relaxation(depth_per_cycle_mm: f64, stiffness_mpa_per_mm: f64, cycle: &MeanCycle<'_>) -> f64 {
    let (slid, pressed) = (cycle.sliding_distance_mm, cycle.pressure_slip_mpa_mm);
    if pressed > 0.0 {
        depth_per_cycle_mm * stiffness_mpa_per_mm * slid / pressed
    } else {
        0.0
    }
}
