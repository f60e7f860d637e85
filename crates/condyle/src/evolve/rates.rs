//! The wear per cycle, the rate at which wear changes it, and a step of the march.

use serde::{Deserialize, Serialize};

use crate::{
    contact::ContactLaw,
    geometry::{ArticulatingSurface, Insert},
    wear::{MeanCycle, NodeWear, SharedCycle, WearLaw},
};

/// The wear per cycle on the present geometry, the mean over all activities by their shares.
#[derive(Clone, Debug)]
pub(super) struct Rates {
    pub depth_per_cycle_mm: Vec<f64>,
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
        // Where a node alone wears, its pressure falls, and with it its rate.
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
    // Without a volume the sum is zero, and so is the quotient.
    let sum: f64 = volumes.zip(values).map(|(v, value)| v * value).sum();
    sum / volume_mm3(area_mm2, depth_mm).max(f64::MIN_POSITIVE)
}

/// Returns the weight of a node of this depth for the maximum depth.
pub fn weight_of_depth(depth: f64) -> f64 {
    depth.powi(DEEP_POWER)
}

/// A step as the next one uses it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRecord {
    /// Cycles.
    pub interval: f64,
    /// Depth per cycle at every surface node at its start, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Depth of the step at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// Depth of the exact march less this one at every surface node at its start, mm.
    pub error_mm: Vec<f64>,
    /// Area of every surface node's share at its start, mm2.
    pub area_mm2: Vec<f64>,
    /// Rate at which wear flattens the pressure at its start, per cycle.
    pub relaxation_per_cycle: f64,
    /// Change of the depth per cycle at every surface node over the step before, mm; 0 in the first step.
    pub change_before_mm: Vec<f64>,
}

impl StepRecord {
    /// Returns the changes of the depth per cycle at every surface node over the step before and over this one,
    /// which led to `now_mm`, mm, where one reverses the other: both are 0 elsewhere.
    pub fn reversals_mm(&self, now_mm: &[f64]) -> Vec<[f64; 2]> {
        let changes = now_mm.iter().zip(&self.depth_per_cycle_mm);
        let both = self.change_before_mm.iter().zip(changes);
        both.map(|(&before, (now, start))| {
            let change = now - start;
            if before * change < 0.0 {
                [before, change]
            } else {
                [0.0; 2]
            }
        })
        .collect()
    }

    /// Returns the volume worn per cycle at its start, mm3.
    pub fn volume_per_cycle_mm3(&self) -> f64 {
        volume_mm3(&self.area_mm2, &self.depth_per_cycle_mm)
    }

    /// Returns the volume worn, mm3.
    pub fn volume_mm3(&self) -> f64 {
        volume_mm3(&self.area_mm2, &self.depth_mm)
    }
}

/// The march before a step.
#[derive(Clone, Copy)]
pub(super) struct StepStart<'a> {
    pub rates: &'a Rates,
    pub last: Option<&'a StepRecord>,
    /// Depth worn so far at every surface node, mm.
    pub worn_mm: &'a [f64],
    pub cycles: f64,
    pub updates: usize,
    pub creeps: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct WearStep {
    pub interval: f64,
    /// Cycles of the test done after it.
    pub cycles_after: f64,
    /// Depth of the step at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// The same by another rule of second order, mm; the difference estimates the error.
    pub predicted_mm: Vec<f64>,
    /// Depth of the exact march less this one at every surface node at its start, mm.
    pub error_mm: Vec<f64>,
}

impl WearStep {
    pub fn record(self, rates: Rates, last: Option<&StepRecord>) -> StepRecord {
        let now = rates.depth_per_cycle_mm.iter().enumerate();
        let change = |(node, now): (usize, &f64)| {
            last.map_or(0.0, |last| now - last.depth_per_cycle_mm[node])
        };
        StepRecord {
            change_before_mm: now.map(change).collect(),
            interval: self.interval,
            relaxation_per_cycle: rates.relaxation_per_cycle,
            depth_per_cycle_mm: rates.depth_per_cycle_mm,
            depth_mm: self.depth_mm,
            error_mm: self.error_mm,
            area_mm2: rates.area_mm2,
        }
    }
}

/// A step with the cycles that it was computed from.
#[derive(Clone, Copy)]
pub(super) struct SolvedStep<'a> {
    /// The surface that the cycles loaded.
    pub surface: &'a ArticulatingSurface,
    /// One cycle of every activity.
    pub shared: &'a [SharedCycle<'a>],
    /// Their mean at every node.
    pub mean: &'a [MeanCycle<'a>],
    /// Wear per mean cycle at every node.
    pub worn: &'a [NodeWear],
    pub rates: &'a Rates,
    pub step: &'a WearStep,
}
