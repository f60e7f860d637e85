//! Motion and loads of the first cycle.

use condyle::machine::{
    CycleRow, JointIndex,
    knee::{AP, IE, KNEE, MEDIAL},
};

use super::{FinishedRun, Scalar, scalar::scalars};

scalars! { "Motion";
    /// Range of AP in the first cycle. Largest less smallest position of the insert, of the first activity.
    AP_RANGE_MM = Scalar::new("ap_range_mm", "AP range", 2, |run| Some(joint_range(first_cycle(run)?, AP)))
        .headline().estimated().of_knee();

    /// Range of IE in the first cycle. Largest less smallest rotation of the insert, of the first activity.
    IE_RANGE_DEG = Scalar::new("ie_range_deg", "IE range", 2, |run| Some(joint_range(first_cycle(run)?, IE)))
        .headline().estimated().of_knee();

    /// Medial part of the axial force. Averaged over the first cycle of the first activity, weighted by force.
    MEDIAL_LOAD_SHARE = Scalar::new("medial_load_share", "medial load share", 1, |run| {
        Some(medial_load_share(first_cycle(run)?))
    }).headline().share().of_knee();
}

fn first_cycle<'a>(run: &FinishedRun<'a>) -> Option<&'a [CycleRow]> {
    let activity = run.state().activities.first()?;
    Some(&activity.first_and_last.as_ref()?.0.rows)
}

/// Largest less smallest position of a joint, in the unit of files.
pub fn joint_range(rows: &[CycleRow], joint: JointIndex) -> f64 {
    let values = || rows.iter().map(|row| joint.of(&row.positions));
    let (low, high) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
    );
    KNEE.joint(joint).kind().in_files(high - low)
}

/// Medial part of the axial force, weighted by force.
pub(in crate::results) fn medial_load_share(rows: &[CycleRow]) -> f64 {
    let medial: f64 = rows.iter().map(|row| row.region_force_n[MEDIAL]).sum();
    let whole: f64 = rows.iter().map(|row| row.axial_force_n).sum();
    medial / whole
}
