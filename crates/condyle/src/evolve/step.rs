//! A step of the march: an interval of cycles, and what it wears.

use serde::{Deserialize, Serialize};

use super::rates::{Rates, volume_mm3};
use crate::{
    geometry::ArticulatingSurface,
    wear::{MeanCycle, NodeWear, SharedCycle},
};

/// What the next step remembers of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRecord {
    /// Its cycles.
    pub interval: f64,
    /// Depth that a cycle wore at every surface node when it began, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Depth that it wore at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// How much deeper the exact march would have been at every surface node when it began, mm.
    pub error_mm: Vec<f64>,
    /// Area of every surface node's share when it began, mm2.
    pub area_mm2: Vec<f64>,
    /// How fast wear flattened the pressure when it began, a cycle.
    pub relaxation_per_cycle: f64,
}

impl StepRecord {
    /// Volume that a cycle wore when it began, mm3.
    pub fn volume_per_cycle_mm3(&self) -> f64 {
        volume_mm3(&self.area_mm2, &self.depth_per_cycle_mm)
    }

    /// Volume that it wore, mm3.
    pub fn volume_mm3(&self) -> f64 {
        volume_mm3(&self.area_mm2, &self.depth_mm)
    }
}

/// Where a march stands before a step.
#[derive(Clone, Copy)]
pub(super) struct StepStart<'a> {
    /// What a cycle wears now.
    pub rates: &'a Rates,
    /// The step that led here.
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

/// A step of the march.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WearStep {
    /// Its cycles.
    pub interval: f64,
    /// Cycles of the test done after it.
    pub cycles_after: f64,
    /// What it wears at every surface node, mm.
    pub depth_mm: Vec<f64>,
    /// What it would wear by another rule of second order, mm; the difference tells its error.
    pub predicted_mm: Vec<f64>,
    /// How much deeper the exact march would be at every surface node when it begins, mm.
    pub error_mm: Vec<f64>,
}

impl WearStep {
    /// What the next step remembers of this one.
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
    /// The surface that the cycles pressed on.
    pub surface: &'a ArticulatingSurface,
    /// One cycle of every activity.
    pub shared: &'a [SharedCycle<'a>],
    /// Their mean at every node.
    pub mean: &'a [MeanCycle<'a>],
    /// What the mean cycle wears at every node.
    pub worn: &'a [NodeWear],
    pub rates: &'a Rates,
    pub step: &'a WearStep,
}
