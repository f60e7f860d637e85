//! What each activity of a test has worn.

use serde::{Deserialize, Serialize};

use super::{
    comparison_laws::worn, mean_over_wear::volume_mm3, rates::Rates, step_record::WearStep,
};
use crate::{
    geometry::ArticulatingSurface,
    machine::Cycle,
    wear::{MeanCycle, SharedCycle, WearLaw},
};

/// What an activity has worn so far, and how hard it pressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActivityWear {
    /// Its part of the volume worn, mm3: each node's depth is shared out by the sums of p |ds| that the
    /// activities do there, so that the parts of all sum up to the whole.
    pub volume_mm3: f64,
    /// What its cycles would have worn as the only activity, mm3: by the law on its own paths, whose main
    /// direction is then its own. It differs from the part above where the law knows cross-shear.
    pub alone_mm3: f64,
    /// Highest pressure in any of its cycles, anywhere on the surface, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest contact area in any of its cycles, mm2.
    pub peak_contact_area_mm2: f64,
}

/// A step of a test of several activities.
pub(super) struct SharedStep<'a> {
    pub law: &'a dyn WearLaw,
    pub surface: &'a ArticulatingSurface,
    /// What each node went through in all of them.
    pub mean: &'a [MeanCycle<'a>],
    pub rates: &'a Rates,
    pub step: &'a WearStep,
}

impl SharedStep<'_> {
    /// What each of several activities wore in the step; nothing of an only one, which wears all.
    pub fn of_each(&self, activities: &[SharedCycle<'_>], solved: &[Cycle]) -> Vec<ActivityWear> {
        if activities.len() < 2 {
            return Vec::new();
        }
        let each = activities.iter().zip(solved);
        each.map(|(activity, solved)| self.of_activity(*activity, solved))
            .collect()
    }

    /// What an activity wore in the step.
    fn of_activity(&self, activity: SharedCycle<'_>, solved: &Cycle) -> ActivityWear {
        ActivityWear {
            volume_mm3: self.part_mm3(activity),
            alone_mm3: self.alone_mm3(activity),
            peak_pressure_mpa: solved.most(|row| row.peak_pressure_mpa),
            peak_contact_area_mm2: solved.most(|row| row.contact_area_mm2),
        }
    }

    /// Its part of the volume that the step takes.
    fn part_mm3(&self, (share, history): SharedCycle<'_>) -> f64 {
        let part = |node: usize| {
            let all = self.mean[node].pressure_slip_mpa_mm;
            let own = share * history.node(node).pressure_slip_mpa_mm;
            self.step.depth_mm[node] * own / all.max(f64::MIN_POSITIVE)
        };
        let depth_mm: Vec<f64> = (0..self.mean.len()).map(part).collect();
        volume_mm3(&self.rates.area_mm2, &depth_mm)
    }

    /// What its cycles would wear alone, over an interval that goes on as the step takes it.
    fn alone_mm3(&self, (share, history): SharedCycle<'_>) -> f64 {
        let only = [(1.0, history)];
        let shares = self.surface.shares.iter().enumerate();
        let cycles: Vec<MeanCycle<'_>> = shares
            .map(|(node, of_surface)| MeanCycle::of(&only, node, of_surface.area_mm2))
            .collect();
        let worn = worn(self.law, &cycles);
        let depth_mm: Vec<f64> = worn.iter().map(|worn| worn.depth_mm).collect();
        let area_mm2 = &self.rates.area_mm2;
        let cycles = volume_mm3(area_mm2, &self.step.depth_mm)
            / self.rates.volume_per_cycle_mm3().max(f64::MIN_POSITIVE);
        share * volume_mm3(area_mm2, &depth_mm) * cycles
    }
}

impl ActivityWear {
    /// With what a further step wore.
    pub(super) fn and(self, more: Self) -> Self {
        Self {
            volume_mm3: self.volume_mm3 + more.volume_mm3,
            alone_mm3: self.alone_mm3 + more.alone_mm3,
            peak_pressure_mpa: self.peak_pressure_mpa.max(more.peak_pressure_mpa),
            peak_contact_area_mm2: self.peak_contact_area_mm2.max(more.peak_contact_area_mm2),
        }
    }
}
