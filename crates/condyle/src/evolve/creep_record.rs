//! What an update tells of creep.

use serde::{Deserialize, Serialize};

/// Creep so far, and the place where the surface lies deepest by wear and creep together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreepRecord {
    /// Volume that the surface has gone down by without loss of mass, from depth times area, mm3.
    pub volume_mm3: f64,
    /// Deepest creep, mm.
    pub max_depth_mm: f64,
    /// Deepest penetration, wear and creep together, mm.
    pub max_penetration_mm: f64,
    /// What of that is wear, mm.
    pub wear_there_mm: f64,
    /// What of that is creep, mm.
    pub creep_there_mm: f64,
    /// Deepest place that a scan would find once the insert has rested without load, mm: wear, and what of creep
    /// is left.
    pub max_unloaded_mm: f64,
}

/// Depths at every surface node, mm.
pub(super) struct Depths<'a> {
    pub wear_mm: &'a [f64],
    pub creep_mm: &'a [f64],
    /// What of creep is left on an unloaded insert.
    pub left_mm: &'a [f64],
}

impl Depths<'_> {
    /// What they come to, with the volume of creep.
    pub fn record(&self, volume_mm3: f64) -> CreepRecord {
        let penetration = |node: usize| self.wear_mm[node] + self.creep_mm[node];
        let unloaded = |node: usize| self.wear_mm[node] + self.left_mm[node];
        let nodes = || 0..self.wear_mm.len();
        let deepest = nodes().max_by(|a, b| penetration(*a).total_cmp(&penetration(*b)));
        let at = |values: &[f64]| deepest.map_or(0.0, |node| values[node]);
        CreepRecord {
            volume_mm3,
            max_depth_mm: self.creep_mm.iter().copied().fold(0.0, f64::max),
            max_penetration_mm: deepest.map_or(0.0, penetration),
            wear_there_mm: at(self.wear_mm),
            creep_there_mm: at(self.creep_mm),
            max_unloaded_mm: nodes().map(unloaded).fold(0.0, f64::max),
        }
    }
}
