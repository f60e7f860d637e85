//! What a cycle wears, and how soon wear changes that.

use super::{
    Activity,
    mean_over_wear::{mean_over_volume, volume_mm3},
};
use crate::{
    contact::{ContactLaw, CycleHistory},
    geometry::{ArticulatingSurface, Insert},
    wear::WearLaw,
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

/// The laws and the bodies that cycles wear by.
pub(super) struct Wearing<'a> {
    pub wear: &'a dyn WearLaw,
    pub contact: &'a dyn ContactLaw,
    pub insert: &'a Insert,
    pub surface: &'a ArticulatingSurface,
}

impl Rates {
    /// Those of activities with the history of one cycle each.
    pub fn of(wearing: &Wearing<'_>, cycles: &[(&Activity, &CycleHistory)]) -> Self {
        let nodes = 0..wearing.surface.positions.len();
        let rate = |node| depth_per_cycle_mm(wearing.wear, cycles, node);
        let depth_per_cycle_mm: Vec<f64> = nodes.clone().map(rate).collect();
        let shares = wearing.surface.shares.iter();
        let area_mm2: Vec<f64> = shares.map(|share| share.area_mm2).collect();
        let alone = |node: usize| {
            let stiffness = wearing.contact.stiffness_mpa_per_mm(wearing.insert, node);
            relaxation(depth_per_cycle_mm[node], stiffness, cycles, node)
        };
        let node_relaxation_per_cycle: Vec<f64> = nodes.map(alone).collect();
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

fn depth_per_cycle_mm(
    law: &dyn WearLaw,
    cycles: &[(&Activity, &CycleHistory)],
    node: usize,
) -> f64 {
    let depth = |(activity, history): &(&Activity, &CycleHistory)| {
        activity.share * law.depth_per_cycle_mm(&history.node(node))
    };
    cycles.iter().map(depth).sum()
}

/// How fast a node's pressure falls as the node alone wears, a cycle: rate times the pressure
/// that a millimetre of depth takes away, over the mean pressure while it slides.
fn relaxation(
    depth_per_cycle_mm: f64,
    stiffness_mpa_per_mm: f64,
    cycles: &[(&Activity, &CycleHistory)],
    node: usize,
) -> f64 {
    let (mut slid, mut pressed) = (0.0, 0.0);
    for (activity, history) in cycles {
        let history = history.node(node);
        slid += activity.share * history.sliding_distance_mm;
        pressed += activity.share * history.pressure_slip_mpa_mm;
    }
    if pressed > 0.0 {
        depth_per_cycle_mm * stiffness_mpa_per_mm * slid / pressed
    } else {
        0.0
    }
}
