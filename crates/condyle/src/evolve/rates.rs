//! What one cycle wears, and how soon wear changes that.

use crate::{
    contact::{FoundationSettings, NodeHistory},
    geometry::ArticulatingSurface,
    machine::Cycle,
    wear::WearLaw,
};

/// What a cycle wears on the present geometry.
pub(super) struct Rates {
    /// Depth at every surface node, mm a cycle.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Area of every node's share of the surface, mm2.
    pub area_mm2: Vec<f64>,
    /// How fast the pressure at every node falls as the node alone wears, a cycle: see [`relaxation`].
    pub node_relaxation_per_cycle: Vec<f64>,
    /// The mean of that over the worn volume: how fast wear flattens the pressure, a cycle.
    pub relaxation_per_cycle: f64,
}

impl Rates {
    /// Those of a solved cycle; `thickness_mm` one a surface node.
    pub fn of(
        cycle: &Cycle,
        surface: &ArticulatingSurface,
        law: &dyn WearLaw,
        contact: &FoundationSettings,
        thickness_mm: &[f64],
    ) -> Self {
        let nodes = 0..cycle.history.node_count();
        let depth_per_cycle_mm: Vec<f64> = nodes
            .clone()
            .map(|node| law.depth_per_cycle_mm(&cycle.history.node(node)))
            .collect();
        let area_mm2: Vec<f64> = surface.shares.iter().map(|share| share.area_mm2).collect();
        let alone = |node: usize| {
            let stiffness = contact.law.pressure(0.0, thickness_mm[node]).1;
            let rate = depth_per_cycle_mm[node];
            relaxation(rate, stiffness, &cycle.history.node(node))
        };
        let node_relaxation_per_cycle: Vec<f64> = nodes.map(alone).collect();
        Self {
            relaxation_per_cycle: mean(&area_mm2, &depth_per_cycle_mm, &node_relaxation_per_cycle),
            depth_per_cycle_mm,
            area_mm2,
            node_relaxation_per_cycle,
        }
    }

    /// Volume worn by a cycle, mm3.
    pub fn volume_per_cycle_mm3(&self) -> f64 {
        total(&self.area_mm2, &self.depth_per_cycle_mm)
    }
}

/// Sum of depth times area.
pub(super) fn total(area_mm2: &[f64], depth_mm: &[f64]) -> f64 {
    area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d).sum()
}

/// Mean of `values` over the volume that `depth_mm` makes; 0 where there is none.
pub(super) fn mean(area_mm2: &[f64], depth_mm: &[f64], values: &[f64]) -> f64 {
    let volumes = area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d);
    let sum: f64 = volumes.zip(values).map(|(v, value)| v * value).sum();
    sum / total(area_mm2, depth_mm).max(f64::MIN_POSITIVE)
}

/// How fast a node's pressure falls as the node alone wears, a cycle: rate times the pressure
/// that a millimetre of depth takes away, over the mean pressure while it slides.
fn relaxation(
    depth_per_cycle_mm: f64,
    stiffness_mpa_per_mm: f64,
    history: &NodeHistory<'_>,
) -> f64 {
    let (slid, pressed) = (history.sliding_distance_mm, history.pressure_slip_mpa_mm);
    match pressed > 0.0 {
        true => depth_per_cycle_mm * stiffness_mpa_per_mm * slid / pressed,
        false => 0.0,
    }
}
