//! What a cycle wears, and how soon wear changes that.

use crate::{
    contact::ContactLaw,
    geometry::{ArticulatingSurface, Insert},
    wear::{MeanCycle, NodeWear, SharedCycle, WearLaw},
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

impl Rates {
    /// The rates of nodes that go through `cycles`, each of which wears them by `worn`.
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
        let alone = |node: usize| {
            let stiffness = contact.stiffness_mpa_per_mm(insert, node);
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

/// What every node of the surface went through.
pub(super) fn mean_cycles<'a>(
    cycles: &'a [SharedCycle<'a>],
    surface: &ArticulatingSurface,
) -> Vec<MeanCycle<'a>> {
    let shares = surface.shares.iter().enumerate();
    shares
        .map(|(node, share)| MeanCycle::new(cycles, node, share.area_mm2))
        .collect()
}

/// What a cycle wears by a law at every node.
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

/// The deepest node counts most for the maximum depth: each node by this power of its depth, high enough
/// to see the bottom of the scar alone, low enough to average over the nodes there.
const DEEP_POWER: i32 = 8;

/// Sum of depth times area, mm3.
pub(super) fn volume_mm3(area_mm2: &[f64], depth_mm: &[f64]) -> f64 {
    area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d).sum()
}

/// Mean of `values` over the volume that `depth_mm` makes; 0 where there is none.
pub fn mean_over_volume(area_mm2: &[f64], depth_mm: &[f64], values: &[f64]) -> f64 {
    let volumes = area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d);
    let sum: f64 = volumes.zip(values).map(|(v, value)| v * value).sum();
    sum / volume_mm3(area_mm2, depth_mm).max(f64::MIN_POSITIVE)
}

/// How much a node of this depth counts for the maximum depth.
pub fn weight_of_depth(depth: f64) -> f64 {
    depth.powi(DEEP_POWER)
}
