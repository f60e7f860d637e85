//! The pose of the femur in the insert frame: at neutral, and at every increment of the first and the last cycle.

use condyle::{
    evolve::March,
    machine::knee::{FLEXION, IE, KNEE, VV},
    spatial::Pose,
};
use serde::{Deserialize, Serialize};

use super::{
    side::{Side, pose_on_side},
    tables::{line, rows_of},
};

/// The pose in which the femur settles under the load at the start of the cycle, where AP, ML and IS read zero: a
/// point p of the femoral frame is at R p + t in the insert frame, each of the knee's own side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NeutralPose {
    /// t, the origin of the femoral frame in the insert frame: x, y, z, mm.
    pub femoral_origin_mm: [f64; 3],
    /// R, its rows.
    pub rotation: [[f64; 3]; 3],
    /// Flexion of R, degrees.
    pub flexion_deg: f64,
    /// Internal rotation of the insert, degrees.
    pub ie_deg: f64,
    /// Varus of the insert, degrees.
    pub vv_deg: f64,
}

impl NeutralPose {
    /// Returns the neutral pose of a march, in a knee of the given side.
    pub fn of(march: &March, side: Side) -> Self {
        let pose = pose_on_side(&march.neutral_pose(), side);
        let settled = &march.state().settled;
        let turned = |joint| KNEE.joint(joint).kind().in_files(joint.of(settled));
        Self {
            femoral_origin_mm: pose.translation.into(),
            rotation: rows(&pose),
            flexion_deg: turned(FLEXION),
            ie_deg: turned(IE),
            vv_deg: turned(VV),
        }
    }
}

/// Returns `femur_pose.csv`: one row per increment of the cycles of `kinematics.csv`, the origin of the femoral frame
/// in the insert frame, then R row by row.
pub fn femur_pose_csv(march: &March, side: Side) -> String {
    let mut text = String::from(
        "cycles,percent,origin_x_mm,origin_y_mm,origin_z_mm,r_xx,r_xy,r_xz,r_yx,r_yy,r_yz,r_zx,r_zy,r_zz\n",
    );
    let cycles = march.state().activities[0].first_and_last.as_ref();
    for (cycles, row) in rows_of(cycles) {
        // A left knee is computed as a right one: its pose is mirrored back.
        let pose = pose_on_side(&march.pose_at(&row.positions), side);
        let rotation = rows(&pose);
        let numbers = pose.translation.iter().chain(rotation.as_flattened());
        let cells = [&cycles, &row.percent].into_iter().chain(numbers);
        text += &line(cells.map(f64::to_string));
    }
    text
}

fn rows(pose: &Pose) -> [[f64; 3]; 3] {
    let r = &pose.rotation;
    [0, 1, 2].map(|row| [r[(row, 0)], r[(row, 1)], r[(row, 2)]])
}
