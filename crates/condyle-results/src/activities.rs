//! Motion, loads and wear of each of several activities.

use condyle::{
    evolve::{Activity, ActivityState, March},
    machine::{
        CycleRow,
        knee::{AP, IE},
    },
};
use serde::{Deserialize, Serialize};

use super::cycle_motion::{joint_range, medial_load_share};

/// Motion, loads and wear of one of several activities; units are in the names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActivitySummary {
    /// Its name in the case.
    pub name: String,
    /// Its share of all cycles.
    pub share_of_cycles: f64,
    /// Its motions and loads, in the columns of `kinematics.csv`.
    pub kinematics_file: String,
    /// Its part of the mass worn, mg: the wear of each place is divided by pressure times sliding there.
    pub mass_loss_mg: f64,
    /// Its part of the volume worn, mm3.
    pub volume_loss_mm3: f64,
    /// Wear of its cycles alone, with their own principal direction, mm3.
    pub volume_loss_alone_mm3: f64,
    /// Highest pressure in any of its cycles, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest contact area in any of its cycles, mm2.
    pub peak_contact_area_mm2: f64,
    /// Highest axial force of its first cycle, N.
    pub peak_axial_force_n: f64,
    /// Range of AP in its first cycle, mm.
    pub ap_range_mm: f64,
    /// Range of IE in its first cycle, degrees.
    pub ie_range_deg: f64,
    /// Medial part of the axial force in its first cycle.
    pub medial_load_share: f64,
}

impl ActivitySummary {
    /// Returns the activities of a march with several activities; empty for a march with one.
    pub fn of(march: &March) -> Vec<Self> {
        let (test, state) = (march.test(), march.state());
        if test.activities.len() < 2 {
            return Vec::new();
        }
        let activities = test.activities.iter().zip(&state.activities).enumerate();
        let summaries = activities.filter_map(|(number, (activity, state))| {
            Self::of_one(number, activity, state, test.density_mg_per_mm3)
        });
        summaries.collect()
    }

    fn of_one(
        number: usize,
        activity: &Activity,
        state: &ActivityState,
        density_mg_per_mm3: f64,
    ) -> Option<Self> {
        let rows: &[CycleRow] = &state.first_and_last.as_ref()?.0.rows;
        let wear = &state.wear;
        Some(Self {
            name: activity.name.clone(),
            share_of_cycles: activity.share,
            kinematics_file: kinematics_file(number, &activity.name),
            mass_loss_mg: density_mg_per_mm3 * wear.volume_mm3,
            volume_loss_mm3: wear.volume_mm3,
            volume_loss_alone_mm3: wear.alone_mm3,
            peak_pressure_mpa: wear.peak_pressure_mpa,
            peak_contact_area_mm2: wear.peak_contact_area_mm2,
            peak_axial_force_n: rows.iter().map(|row| row.axial_force_n).fold(0.0, f64::max),
            ap_range_mm: joint_range(rows, AP),
            ie_range_deg: joint_range(rows, IE),
            medial_load_share: medial_load_share(rows),
        })
    }
}

/// Returns the name of the file with the motions and loads of activity number `number`. The first activity has the
/// file name of a run with one activity.
pub fn kinematics_file(number: usize, name: &str) -> String {
    if number == 0 {
        return "kinematics.csv".to_owned();
    }
    format!("kinematics_{name}.csv")
}

/// Returns the names of the activities that a case lists.
#[cfg(feature = "file-system")]
pub(super) fn listed_in(case: &str) -> Vec<String> {
    let case: toml::Table = case.parse().unwrap_or_default();
    let listed = case.get("activity").and_then(toml::Value::as_array);
    let name = |activity: &toml::Value| Some(activity.get("name")?.as_str()?.to_owned());
    listed.into_iter().flatten().filter_map(name).collect()
}
