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
    /// How fast wear flattens the pressure, a cycle: see [`relaxation`].
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
        let weighted = nodes.map(|node| {
            let stiffness = contact.law.pressure(0.0, thickness_mm[node]).1;
            let rate = depth_per_cycle_mm[node];
            let volume = rate * area_mm2[node];
            volume * relaxation(rate, stiffness, &cycle.history.node(node))
        });
        let volume = total(&area_mm2, &depth_per_cycle_mm);
        let relaxation_per_cycle = weighted.sum::<f64>() / volume.max(f64::MIN_POSITIVE);
        Self {
            depth_per_cycle_mm,
            area_mm2,
            relaxation_per_cycle,
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

/// How fast a node's pressure falls as the node alone wears, a cycle: rate times the pressure
/// that a millimetre of depth takes away, over the mean pressure while it slides.
fn relaxation(
    depth_per_cycle_mm: f64,
    stiffness_mpa_per_mm: f64,
    history: &NodeHistory<'_>,
) -> f64 {
    let (mut slid, mut pressed) = (0.0, 0.0);
    for moment in history.moments {
        let slip = moment.distance_mm();
        slid += slip;
        pressed += moment.pressure_mpa * slip;
    }
    match pressed > 0.0 {
        true => depth_per_cycle_mm * stiffness_mpa_per_mm * slid / pressed,
        false => 0.0,
    }
}
