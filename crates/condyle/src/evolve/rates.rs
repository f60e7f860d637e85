//! The wear per cycle, and the rate at which wear changes it.

use crate::{
    contact::ContactLaw,
    geometry::{ArticulatingSurface, Insert},
    wear::{MeanCycle, NodeWear, SharedCycle, WearLaw},
};

/// The wear per cycle on the present geometry, the mean over all activities by their shares.
#[derive(Clone, Debug)]
pub(super) struct Rates {
    /// Depth at every surface node, mm per cycle.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Area of every node's share of the surface, mm2.
    pub area_mm2: Vec<f64>,
    /// Relative decrease of the pressure at every node per cycle if the node alone wears.
    pub node_relaxation_per_cycle: Vec<f64>,
    /// Its mean over the worn volume: the rate at which wear flattens the pressure, per cycle.
    pub relaxation_per_cycle: f64,
}

impl Rates {
    /// Creates the rates of nodes that wear by `worn` in each of their mean `cycles`.
    pub fn new(
        contact: &dyn ContactLaw,
        insert: &Insert,
        surface: &ArticulatingSurface,
        cycles: &[MeanCycle<'_>],
        worn: &[NodeWear],
    ) -> Self {
        let depth_per_cycle_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
        let shares = surface.shares.iter();
        let area_mm2: Vec<f64> = shares.map(|share| share.area_mm2).collect();
        // Rate times the pressure lost per millimetre of depth, over the mean pressure while the node slides.
        let alone = |node: usize| {
            let stiffness_mpa_per_mm = contact.stiffness_mpa_per_mm(insert, node);
            let (slid, pressed) = (
                cycles[node].sliding_distance_mm,
                cycles[node].pressure_slip_mpa_mm,
            );
            if pressed > 0.0 {
                depth_per_cycle_mm[node] * stiffness_mpa_per_mm * slid / pressed
            } else {
                0.0
            }
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

    /// Returns the volume worn per cycle, mm3.
    pub fn volume_per_cycle_mm3(&self) -> f64 {
        volume_mm3(&self.area_mm2, &self.depth_per_cycle_mm)
    }
}

pub(super) fn mean_cycles<'a>(
    cycles: &'a [SharedCycle<'a>],
    surface: &ArticulatingSurface,
) -> Vec<MeanCycle<'a>> {
    let shares = surface.shares.iter().enumerate();
    shares
        .map(|(node, share)| MeanCycle::new(cycles, node, share.area_mm2))
        .collect()
}

/// Returns the wear per mean cycle by a law at every node.
pub(super) fn worn(law: &dyn WearLaw, cycles: &[MeanCycle<'_>]) -> Vec<NodeWear> {
    let worn = |cycle: &MeanCycle<'_>| {
        // Most of a surface is never touched.
        if cycle.sliding_distance_mm == 0.0 {
            return NodeWear::of_depth(0.0);
        }
        law.wear(cycle)
    };
    cycles.iter().map(worn).collect()
}

/// Power of the depth that weighs the nodes for the maximum depth: high enough to see the bottom of the scar only,
/// low enough to average over the nodes there.
const DEEP_POWER: i32 = 8;

pub(super) fn volume_mm3(area_mm2: &[f64], depth_mm: &[f64]) -> f64 {
    area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d).sum()
}

/// Returns the mean of `values` over the volume of `depth_mm`; 0 if there is none.
pub fn mean_over_volume(area_mm2: &[f64], depth_mm: &[f64], values: &[f64]) -> f64 {
    let volumes = area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d);
    let sum: f64 = volumes.zip(values).map(|(v, value)| v * value).sum();
    sum / volume_mm3(area_mm2, depth_mm).max(f64::MIN_POSITIVE)
}

/// Returns the weight of a node of this depth for the maximum depth.
pub fn weight_of_depth(depth: f64) -> f64 {
    depth.powi(DEEP_POWER)
}
