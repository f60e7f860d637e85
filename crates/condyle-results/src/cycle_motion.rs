//! Ranges of motion and shares of load of a cycle.

use condyle::machine::{
    CycleRow, JointIndex,
    knee::{KNEE, MEDIAL},
};

/// Returns the largest less smallest position of a joint, in the unit of files.
pub fn joint_range(rows: &[CycleRow], joint: JointIndex) -> f64 {
    let values = || rows.iter().map(|row| joint.of(&row.positions));
    let (low, high) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
    );
    KNEE.joint(joint).kind().in_files(high - low)
}

pub(super) fn medial_load_share(rows: &[CycleRow]) -> f64 {
    let medial: f64 = rows.iter().map(|row| row.region_force_n[MEDIAL]).sum();
    let whole: f64 = rows.iter().map(|row| row.axial_force_n).sum();
    medial / whole
}
