//! The machine and its contact at the end of an increment.

use serde::{Deserialize, Serialize};

use crate::contact::{ContactResult, MAX_REGIONS};

/// The machine at the end of an increment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRow {
    /// Place in the cycle, %.
    pub percent: f64,
    /// Positions, mm or rad, in the order of the chain.
    pub positions: [f64; 6],
    /// Load pressing the bodies together along y, as the contact carries it, N.
    pub axial_force_n: f64,
    /// Area in contact, mm2.
    pub contact_area_mm2: f64,
    /// Highest pressure anywhere, at a node or between nodes, MPa.
    pub peak_pressure_mpa: f64,
    /// Part of the axial force on every region of the surface, N, in the order of the mechanism's regions.
    pub region_force_n: [f64; MAX_REGIONS],
}

impl CycleRow {
    /// The row at `percent` of the cycle, where the joints are at `positions` and the contact has landed.
    pub(super) fn new(percent: f64, positions: [f64; 6], landing: &ContactResult) -> Self {
        let (mut region_force_n, mut contact_area_mm2) = ([0.0; MAX_REGIONS], 0.0);
        for node in &landing.touched {
            region_force_n[usize::from(node.region)] -= node.force_n.y;
            contact_area_mm2 += node.covered_mm2;
        }
        Self {
            percent,
            positions,
            axial_force_n: region_force_n.iter().sum(),
            contact_area_mm2,
            peak_pressure_mpa: landing.peak_pressure_mpa,
            region_force_n,
        }
    }
}
