//! Stress below the surface of an insert that is a solid, and what has yielded.

use condyle::contact::BacksideAtRest;
use condyle::evolve::{MarchState, UnderSurfaceRecord, UpdateRecord};
use serde::{Deserialize, Serialize};

/// What is below the surface in a finished run; units are in the names.
///
/// Stress is that of the centres of elements, at the increment of each update with the highest pressure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnderSurfaceSummary {
    /// Largest equivalent stress of von Mises, MPa.
    pub peak_von_mises_mpa: f64,
    /// How deep below the surface it is, mm.
    pub peak_von_mises_depth_mm: f64,
    /// Largest shear stress, MPa.
    pub peak_max_shear_mpa: f64,
    /// How deep below the surface it is, mm.
    pub peak_max_shear_depth_mm: f64,
    /// Cycles done before the cycle that has that shear stress.
    pub peak_max_shear_cycle: f64,
    /// Place of it in that cycle, %.
    pub peak_max_shear_percent: f64,
    /// The same of the first cycle, MPa and mm.
    pub first_cycle_max_shear_mpa: f64,
    /// How deep that one is, mm.
    pub first_cycle_max_shear_depth_mm: f64,
    /// What has yielded; not there where the insert is elastic.
    #[serde(flatten)]
    pub plastic: Option<PlasticSummary>,
    /// What the backside did; not there where it is bonded.
    #[serde(flatten)]
    pub backside: Option<BacksideSummary>,
}

/// What a backside that rests on its tray did at most in the last cycle of any update, that of any activity; units are in
/// the names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BacksideSummary {
    /// Farthest that a place of it lifts off the tray, mm.
    pub backside_lift_mm: f64,
    /// Largest part of it that lifts at once, %.
    pub backside_lifted_percent: f64,
    /// Longest way that a place of it slips along the tray in a cycle while it presses, there and back, mm.
    pub backside_slip_mm: f64,
    /// Largest force along the tray that the lock carries, N.
    pub backside_lock_force_n: f64,
    /// Largest moment about the vertical axis that the lock carries, N m.
    pub backside_lock_moment_nm: f64,
}

impl BacksideSummary {
    /// The most of some updates; none where there are none.
    fn most_of(updates: impl Iterator<Item = BacksideAtRest>) -> Option<Self> {
        let most = updates.reduce(|most, other| BacksideAtRest {
            lift_mm: most.lift_mm.max(other.lift_mm),
            lifted_part: most.lifted_part.max(other.lifted_part),
            slip_mm: most.slip_mm.max(other.slip_mm),
            lock_force_n: most.lock_force_n.max(other.lock_force_n),
            lock_moment_nmm: most.lock_moment_nmm.max(other.lock_moment_nmm),
        })?;
        Some(Self {
            backside_lift_mm: most.lift_mm,
            backside_lifted_percent: 100.0 * most.lifted_part,
            backside_slip_mm: most.slip_mm,
            backside_lock_force_n: most.lock_force_n,
            backside_lock_moment_nm: 1e-3 * most.lock_moment_nmm,
        })
    }
}

/// What of an insert has yielded at the end of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlasticSummary {
    /// How far the surface has given way for good at most, mm; wear is not in it.
    pub max_permanent_set_mm: f64,
    /// The same after the first cycle that repeats itself, mm.
    pub first_cycle_permanent_set_mm: f64,
    /// Largest accumulated plastic strain.
    pub max_plastic_strain: f64,
    /// Elements that have yielded.
    pub yielded_elements: usize,
    /// Of these, elements that yield in every cycle still, by more than a strain of 1e-5 a cycle.
    pub ratcheting_elements: usize,
}

impl UnderSurfaceSummary {
    /// That of a march, if its insert is a solid.
    pub fn of(state: &MarchState) -> Option<Self> {
        let updates = state.updates.iter().enumerate();
        let records = || updates.clone().filter_map(numbered);
        let (_, first) = records().next()?;
        let (_, last) = records().next_back()?;
        let (_, stressed) = records().max_by(by(|record| record.von_mises_mpa))?;
        let (update, sheared) = records().max_by(by(|record| record.max_shear_mpa))?;
        Some(Self {
            peak_von_mises_mpa: stressed.von_mises_mpa,
            peak_von_mises_depth_mm: stressed.von_mises_depth_mm,
            peak_max_shear_mpa: sheared.max_shear_mpa,
            peak_max_shear_depth_mm: sheared.max_shear_depth_mm,
            peak_max_shear_cycle: state.cycles_before(update),
            peak_max_shear_percent: sheared.percent,
            first_cycle_max_shear_mpa: first.max_shear_mpa,
            first_cycle_max_shear_depth_mm: first.max_shear_depth_mm,
            plastic: last.plastic.map(|plastic| PlasticSummary {
                max_permanent_set_mm: plastic.max_permanent_set_mm,
                first_cycle_permanent_set_mm: first
                    .plastic
                    .map_or(0.0, |first| first.max_permanent_set_mm),
                max_plastic_strain: plastic.max_plastic_strain,
                yielded_elements: plastic.yielded_elements,
                ratcheting_elements: plastic.ratcheting_elements,
            }),
            backside: BacksideSummary::most_of(records().filter_map(|(_, of)| of.backside)),
        })
    }
}

type Numbered<'a> = (usize, &'a UnderSurfaceRecord);

fn numbered((number, update): (usize, &UpdateRecord)) -> Option<Numbered<'_>> {
    Some((number, update.under_surface.as_ref()?))
}

fn by(
    value: fn(&UnderSurfaceRecord) -> f64,
) -> impl Fn(&Numbered<'_>, &Numbered<'_>) -> std::cmp::Ordering {
    move |a, b| value(a.1).total_cmp(&value(b.1))
}
