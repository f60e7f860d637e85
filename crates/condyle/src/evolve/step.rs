//! A step of the march: its number of cycles, and the wear over them.

use serde::{Deserialize, Serialize};

use super::rates::{Rates, volume_mm3};
use crate::{
    geometry::ArticulatingSurface,
    machine::Cycle,
    wear::{MeanCycle, NodeWear, SharedCycle},
};

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
}

impl StepRecord {
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
    /// Cycles done.
    pub cycles: f64,
    /// Updates done.
    pub updates: usize,
    /// Whether the insert creeps as well.
    pub creeps: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct WearStep {
    /// Cycles.
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
    pub fn record(self, rates: Rates) -> StepRecord {
        StepRecord {
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
    pub cycles: &'a [Cycle],
    /// One cycle of every activity.
    pub shared: &'a [SharedCycle<'a>],
    /// Their mean at every node.
    pub mean: &'a [MeanCycle<'a>],
    /// Wear per mean cycle at every node.
    pub worn: &'a [NodeWear],
    pub rates: &'a Rates,
    pub step: &'a WearStep,
}
