//! Creep of a run, and its separation from wear as in laboratories.

use condyle::evolve::{CreepRecord, MarchState, UpdateRecord};
use serde::{Deserialize, Serialize};

/// Cycles after which laboratories take penetration to grow by wear alone.
const MILLION: f64 = 1e6;

/// Creep of a finished run; units are in the names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreepSummary {
    /// Volume by which the surface has sunk without loss of mass, mm3.
    pub volume_mm3: f64,
    /// Deepest creep, mm.
    pub max_depth_mm: f64,
    /// Deepest penetration, wear and creep together, mm.
    pub max_penetration_mm: f64,
    /// Wear at that place, mm.
    pub wear_there_mm: f64,
    /// Creep at that place, mm.
    pub creep_there_mm: f64,
    /// Deepest place that a scan would find once the insert has rested without load, mm.
    pub max_unloaded_depth_mm: f64,
    /// The deepest penetration after a million cycles; none for a shorter test.
    pub first_million: Option<Penetration>,
    /// The line that a laboratory fits to its scans from a million cycles on; none of fewer than two scans.
    pub line_from_a_million: Option<ScanLine>,
}

/// The deepest penetration and its parts, mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Penetration {
    /// Wear and creep together.
    pub penetration_mm: f64,
    /// Wear there.
    pub wear_mm: f64,
    /// Creep there.
    pub creep_mm: f64,
}

/// A line through the deepest place of unloaded scans against cycles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScanLine {
    /// Its slope, which laboratories take for wear: mm in a million cycles.
    pub rise_mm_per_million_cycles: f64,
    /// Its value at no cycles, which they take for creep and bedding in, mm.
    pub at_no_cycles_mm: f64,
}

impl CreepSummary {
    /// Returns the creep of a finished march, if its insert creeps.
    pub fn of(state: &MarchState) -> Option<Self> {
        let last = state.updates.last()?.creep?;
        Some(Self {
            volume_mm3: last.volume_mm3,
            max_depth_mm: last.max_depth_mm,
            max_penetration_mm: last.max_penetration_mm,
            wear_there_mm: last.wear_there_mm,
            creep_there_mm: last.creep_there_mm,
            max_unloaded_depth_mm: last.max_unloaded_mm,
            first_million: Penetration::at(&state.updates, MILLION),
            line_from_a_million: ScanLine::through(&state.updates, MILLION),
        })
    }
}

impl Penetration {
    /// Returns the penetration after a number of cycles, linear between updates; none for a shorter test.
    fn at(updates: &[UpdateRecord], cycles: f64) -> Option<Self> {
        let after = updates.iter().position(|update| update.cycles >= cycles)?;
        let end = updates[after].creep?;
        let start = after
            .checked_sub(1)
            .and_then(|before| updates[before].creep);
        let began = after
            .checked_sub(1)
            .map_or(0.0, |before| updates[before].cycles);
        let part = (cycles - began) / (updates[after].cycles - began);
        let between = |value: fn(&CreepRecord) -> f64| {
            let from = start.as_ref().map_or(0.0, value);
            from + part * (value(&end) - from)
        };
        Some(Self {
            penetration_mm: between(|record| record.max_penetration_mm),
            wear_mm: between(|record| record.wear_there_mm),
            creep_mm: between(|record| record.creep_there_mm),
        })
    }
}

impl ScanLine {
    /// Returns the least-squares line through the scans from a number of cycles on.
    fn through(updates: &[UpdateRecord], from: f64) -> Option<Self> {
        let scan = |update: &UpdateRecord| Some((update.cycles, update.creep?.max_unloaded_mm));
        let scans = updates.iter().filter(|update| update.cycles >= from);
        let scans: Vec<(f64, f64)> = scans.filter_map(scan).collect();
        let mean = |values: &dyn Fn(&(f64, f64)) -> f64| {
            scans.iter().map(values).sum::<f64>() / scans.len() as f64
        };
        let (cycles, depth) = (mean(&|scan| scan.0), mean(&|scan| scan.1));
        let spread = mean(&|scan| (scan.0 - cycles).powi(2));
        // Scans at one number of cycles have no slope.
        if scans.len() < 2 || spread == 0.0 {
            return None;
        }
        let slope = mean(&|scan| (scan.0 - cycles) * (scan.1 - depth)) / spread;
        Some(Self {
            rise_mm_per_million_cycles: slope * MILLION,
            at_no_cycles_mm: depth - slope * cycles,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn update(cycles: f64, penetration_mm: f64, wear_mm: f64, unloaded_mm: f64) -> UpdateRecord {
        let creep = CreepRecord {
            volume_mm3: 0.0,
            max_depth_mm: 0.0,
            max_penetration_mm: penetration_mm,
            wear_there_mm: wear_mm,
            creep_there_mm: penetration_mm - wear_mm,
            max_unloaded_mm: unloaded_mm,
        };
        UpdateRecord {
            cycles,
            volume_loss_mm3: 0.0,
            volume_loss_mesh_mm3: 0.0,
            mass_loss_mg: 0.0,
            max_depth_mm: wear_mm,
            peak_pressure_mpa: 0.0,
            peak_contact_area_mm2: 0.0,
            cycles_solved: 1.0,
            repeats: true,
            worst_quality: 1.0,
            creep: Some(creep),
            under_surface: None,
        }
    }

    #[test]
    fn verify_a_million_lies_between_updates() {
        let updates = [
            update(8e5, 0.10, 0.02, 0.06),
            update(1.2e6, 0.14, 0.03, 0.08),
        ];
        let found = Penetration::at(&updates, 1e6).expect("it is reached");
        assert!((found.penetration_mm - 0.12).abs() < 1e-12);
        assert!((found.wear_mm - 0.025).abs() < 1e-12 && (found.creep_mm - 0.095).abs() < 1e-12);
        assert_eq!(Penetration::at(&updates[..1], 1e6), None);
        let first = Penetration::at(&updates[1..], 1e6).expect("it is reached");
        assert!((first.penetration_mm - 0.14 / 1.2).abs() < 1e-12);
    }

    #[test]
    fn verify_a_straight_rise_is_met_by_the_line() {
        let scans = [1e6, 2e6, 4e6].map(|cycles| update(cycles, 0.0, 0.0, 0.05 + 2e-8 * cycles));
        let line = ScanLine::through(&scans, 1e6).expect("three are enough");
        assert!((line.rise_mm_per_million_cycles - 0.02).abs() < 1e-12);
        assert!((line.at_no_cycles_mm - 0.05).abs() < 1e-12);
        assert_eq!(ScanLine::through(&scans[..1], 1e6), None);
    }
}
