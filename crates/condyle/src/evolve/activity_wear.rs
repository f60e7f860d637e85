//! The wear of each activity of a test.

use serde::{Deserialize, Serialize};

use super::rates::{SolvedStep, mean_cycles, volume_mm3, worn};
use crate::wear::{SharedCycle, WearLaw};

/// Wear and contact of an activity so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActivityWear {
    /// Part of the volume worn, mm3: each node's depth is divided in proportion to the activities' sums of
    /// p |ds| there, so that the parts add up to the whole.
    pub volume_mm3: f64,
    /// Volume that its cycles would have worn as the only activity, mm3, with the principal direction of its
    /// own paths. It differs from the part above where the law depends on cross-shear.
    pub alone_mm3: f64,
    /// Highest pressure in any of its cycles, anywhere on the surface, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest contact area in any of its cycles, mm2.
    pub peak_contact_area_mm2: f64,
}

/// Returns the wear of each of several activities in a step; nothing for a single one, which causes all wear.
pub(super) fn wear_of_each(law: &dyn WearLaw, interval: &SolvedStep<'_>) -> Vec<ActivityWear> {
    let solved = interval.cycles;
    if solved.len() < 2 {
        return Vec::new();
    }
    let each = interval.shared.iter().zip(solved);
    each.map(|(activity, solved)| ActivityWear {
        volume_mm3: part_mm3(interval, *activity),
        alone_mm3: alone_mm3(law, interval, *activity),
        peak_pressure_mpa: solved.max(|row| row.peak_pressure_mpa),
        peak_contact_area_mm2: solved.max(|row| row.contact_area_mm2),
    })
    .collect()
}

/// Returns the activity's part of the volume that the step takes, mm3.
fn part_mm3(interval: &SolvedStep<'_>, (share, history): SharedCycle<'_>) -> f64 {
    let part = |node: usize| {
        let all = interval.mean[node].pressure_slip_mpa_mm;
        let own = share * history.sums(node).pressure_slip_mpa_mm;
        // Nodes that no activity loads have a depth of 0; the bound avoids 0/0.
        interval.step.depth_mm[node] * own / all.max(f64::MIN_POSITIVE)
    };
    let depth_mm: Vec<f64> = (0..interval.mean.len()).map(part).collect();
    volume_mm3(&interval.rates.area_mm2, &depth_mm)
}

/// Returns the volume that the activity's cycles would wear alone, mm3: their rate times the number of cycles by
/// which the step extrapolates the rate of all activities.
fn alone_mm3(
    law: &dyn WearLaw,
    interval: &SolvedStep<'_>,
    (share, history): SharedCycle<'_>,
) -> f64 {
    // A share of 1: the law sees the cross-shear of this activity alone.
    let worn = worn(law, &mean_cycles(&[(1.0, history)], interval.surface));
    let depth_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
    let area_mm2 = &interval.rates.area_mm2;
    let cycles = volume_mm3(area_mm2, &interval.step.depth_mm)
        / interval.rates.volume_per_cycle_mm3().max(f64::MIN_POSITIVE);
    share * volume_mm3(area_mm2, &depth_mm) * cycles
}

impl ActivityWear {
    pub(super) fn and(self, more: Self) -> Self {
        Self {
            volume_mm3: self.volume_mm3 + more.volume_mm3,
            alone_mm3: self.alone_mm3 + more.alone_mm3,
            peak_pressure_mpa: self.peak_pressure_mpa.max(more.peak_pressure_mpa),
            peak_contact_area_mm2: self.peak_contact_area_mm2.max(more.peak_contact_area_mm2),
        }
    }
}
