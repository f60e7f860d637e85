//! Entries of `summary.json` that are not single numbers: activities, the wear of every law, and the neutral
//! pose of the femur.

use condyle::{
    evolve::March,
    machine::{
        CycleRow, JointDescription, JointIndex, Mechanism, extremes,
        knee::{AP, FLEXION, IE, KNEE, MEDIAL, VV},
    },
    spatial::Pose,
};
use serde::{Deserialize, Serialize};

use super::side::{Side, pose_on_side};

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
    /// Results that only a knee simulator has.
    #[serde(flatten)]
    pub knee: Option<KneeActivity>,
}

/// Motion and load of an activity of a knee simulator, in its first cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KneeActivity {
    /// Range of AP, mm.
    pub ap_range_mm: f64,
    /// Range of IE, degrees.
    pub ie_range_deg: f64,
    /// Medial part of the axial force.
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
            let rows: &[CycleRow] = &state.first_and_last.as_ref()?.0.rows;
            let wear = &state.wear;
            Some(Self {
                name: activity.name.clone(),
                share_of_cycles: activity.share,
                kinematics_file: kinematics_file(number, &activity.name),
                mass_loss_mg: test.density_mg_per_mm3 * wear.volume_mm3,
                volume_loss_mm3: wear.volume_mm3,
                volume_loss_alone_mm3: wear.alone_mm3,
                peak_pressure_mpa: wear.peak_pressure_mpa,
                peak_contact_area_mm2: wear.peak_contact_area_mm2,
                peak_axial_force_n: rows.iter().map(|row| row.axial_force_n).fold(0.0, f64::max),
                knee: (*activity.machine.mechanism == KNEE).then(|| KneeActivity {
                    ap_range_mm: joint_range(rows, &KNEE, AP),
                    ie_range_deg: joint_range(rows, &KNEE, IE),
                    medial_load_share: medial_load_share(rows),
                }),
            })
        });
        summaries.collect()
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

/// Returns the largest less smallest position of a joint of a machine, in the unit of files.
pub fn joint_range(rows: &[CycleRow], mechanism: &Mechanism, joint: JointIndex) -> f64 {
    let [low, high] = extremes(rows.iter().map(|row| joint.of(&row.positions)));
    mechanism.joint(joint).kind().in_files(high - low)
}

pub(super) fn medial_load_share(rows: &[CycleRow]) -> f64 {
    let medial: f64 = rows.iter().map(|row| row.region_force_n[MEDIAL]).sum();
    let whole: f64 = rows.iter().map(|row| row.axial_force_n).sum();
    medial / whole
}

/// Wear by one law: the wear of the run for the law that moved the surface, and the wear predicted for the same
/// histories for every other law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawWear {
    /// The word for the law.
    pub law: String,
    /// True of the law that moved the surface, with the constants of the case; the others have their defaults.
    pub moved_the_surface: bool,
    /// True if its formula or a constant was quoted from memory.
    pub approximate: bool,
    /// Mass, mg.
    pub mass_loss_mg: f64,
    /// Mean mass in a million cycles, mg.
    pub mass_loss_mg_per_million_cycles: f64,
    /// Volume, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Deepest wear, mm.
    pub max_depth_mm: f64,
    /// Part of the volume worn at pressures and cross-shear outside the range that the law was fitted to, %; none if
    /// the range is not known.
    pub outside_of_fit_percent: Option<f64>,
}

impl LawWear {
    /// Returns the wear of a march by its law, called `word`, then by its comparison laws. `is_approximate` returns
    /// whether the law of a word was quoted from memory.
    pub fn of(march: &March, word: &str, is_approximate: impl Fn(&str) -> bool) -> Vec<Self> {
        let state = march.state();
        let Some(last) = state.updates.last() else {
            return Vec::new();
        };
        let density = march.test().density_mg_per_mm3;
        let law = |word: &str, volume_mm3: f64, depth_mm, outside_mm3: Option<f64>| Self {
            law: word.to_owned(),
            moved_the_surface: false,
            approximate: is_approximate(word),
            mass_loss_mg: density * volume_mm3,
            mass_loss_mg_per_million_cycles: density * volume_mm3 / last.cycles * 1e6,
            volume_loss_mm3: volume_mm3,
            max_depth_mm: depth_mm,
            // Both volumes are sums of extrapolated steps, whose rounding may lead to slightly more than 100 %.
            outside_of_fit_percent: outside_mm3.map(|outside_mm3| {
                (100.0 * outside_mm3 / volume_mm3.max(f64::MIN_POSITIVE)).clamp(0.0, 100.0)
            }),
        };
        let chosen = Self {
            moved_the_surface: true,
            ..law(
                word,
                last.volume_loss_mm3,
                last.max_depth_mm,
                state.outside_mm3,
            )
        };
        let others = state.comparison_laws.iter().map(|other| {
            let (volume_mm3, depth_mm) = (other.volume_mm3, other.max_depth_mm());
            law(&other.word, volume_mm3, depth_mm, other.outside_mm3)
        });
        std::iter::once(chosen).chain(others).collect()
    }
}

/// A joint of the machine as a column of `kinematics.csv`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MotionColumn {
    /// Name of the column, which ends in the unit.
    pub column: String,
    /// Heading.
    pub title: String,
    /// Positive direction in words.
    pub positive: String,
}

impl MotionColumn {
    /// Returns the joints of a mechanism in the order of files.
    pub fn all_of(mechanism: &Mechanism) -> Vec<Self> {
        let joints = mechanism.in_files.iter();
        let joints = joints.map(|&index| mechanism.joint(index));
        let column = |joint: &JointDescription| Self {
            column: joint.column.to_owned(),
            title: joint.title.to_owned(),
            positive: joint.positive.to_owned(),
        };
        joints.map(column).collect()
    }
}

/// The pose in which the femur settles under the load at the start of the cycle, where AP, ML and IS of a knee read zero: a
/// point p of the femoral frame is at R p + t in the insert frame, each of the joint's own side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NeutralPose {
    /// t, the origin of the femoral frame in the insert frame: x, y, z, mm.
    pub femoral_origin_mm: [f64; 3],
    /// R, its rows.
    pub rotation: [[f64; 3]; 3],
    /// The angles of R; of a knee only.
    #[serde(flatten)]
    pub angles: Option<NeutralAngles>,
}

/// Angles of the settled femur of a knee, degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NeutralAngles {
    /// Flexion.
    pub flexion_deg: f64,
    /// Internal rotation of the insert.
    pub ie_deg: f64,
    /// Varus of the insert.
    pub vv_deg: f64,
}

impl NeutralPose {
    /// Returns the neutral pose of a march, in a joint of the given side.
    pub fn new(march: &March, side: Side) -> Self {
        let pose = pose_on_side(&march.neutral_pose(), side);
        let settled = &march.state().settled;
        let turned = |joint| KNEE.joint(joint).kind().in_files(joint.of(settled));
        let is_knee = *march.test().machine().mechanism == KNEE;
        Self {
            femoral_origin_mm: pose.translation.into(),
            rotation: rotation_rows(&pose),
            angles: is_knee.then(|| NeutralAngles {
                flexion_deg: turned(FLEXION),
                ie_deg: turned(IE),
                vv_deg: turned(VV),
            }),
        }
    }
}

pub(super) fn rotation_rows(pose: &Pose) -> [[f64; 3]; 3] {
    let r = &pose.rotation;
    [0, 1, 2].map(|row| [r[(row, 0)], r[(row, 1)], r[(row, 2)]])
}
