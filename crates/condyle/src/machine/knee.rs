//! The knee simulator as a table.
//!
//! The insert carries VV nearest to it, then IE, ML and AP towards the frame; the femur flexes on a
//! carriage that moves IS. All that is said of these six joints anywhere is said here: a case's keys, the
//! columns of its results, messages and pages look it up.

use super::{
    Axis, Channel, ChannelUnit, CycleQuantity, JointDescription, JointIndex, Loading, Mechanism,
    MovedBody, Region, Settling,
};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Mass that shifts with a joint, tonne: that of a carriage, approximate; no source gives it.
pub const MASS_TONNE: f64 = 5e-3;
/// Moment of inertia that turns with a joint, tonne mm2: that mass at a radius of 45 mm.
pub const MOMENT_OF_INERTIA_TONNE_MM2: f64 = 10.0;
/// Viscous damping of a shift, N s/mm: with that mass 0.36 and 0.79 of critical on the springs.
pub const DAMPING_N_S_PER_MM: f64 = 0.3;
/// Viscous damping of a turn, N mm s/rad: with that inertia 0.19 and 0.42 of critical on the springs.
pub const DAMPING_NMM_S_PER_RAD: f64 = 200.0;

/// Compression of the joint; it pushes the femur down, against IS.
pub static AXIAL_FORCE: Channel = Channel {
    name: "axial_force",
    about: "Compression of the joint.",
    unit: ChannelUnit::Newton,
    sign: -1.0,
    least: 0.0,
    most: 20_000.0,
};

/// Flexion of the femur.
pub static FLEXION_MOTION: Channel = Channel {
    name: "flexion",
    about: "Flexion of the femur, + flexion.",
    unit: ChannelUnit::Degree,
    sign: 1.0,
    least: -45.0,
    most: 180.0,
};

/// Antero-posterior force on the insert.
pub static AP_FORCE: Channel = Channel {
    name: "ap_force",
    about: "AP force on the insert, + anterior.",
    unit: ChannelUnit::Newton,
    sign: 1.0,
    least: -5000.0,
    most: 5000.0,
};

/// Torque on the insert.
pub static IE_TORQUE: Channel = Channel {
    name: "ie_torque",
    about: "Torque on the insert, + internal.",
    unit: ChannelUnit::NewtonMetre,
    sign: 1.0,
    least: -200.0,
    most: 200.0,
};

/// Antero-posterior motion of the insert.
pub static AP_MOTION: Channel = Channel {
    name: "ap_motion",
    about: "AP motion of the insert, + anterior.",
    unit: ChannelUnit::Millimetre,
    sign: 1.0,
    least: -50.0,
    most: 50.0,
};

/// Internal-external rotation of the insert.
pub static IE_MOTION: Channel = Channel {
    name: "ie_motion",
    about: "IE rotation of the insert, + internal.",
    unit: ChannelUnit::Degree,
    sign: 1.0,
    least: -90.0,
    most: 90.0,
};

const JOINTS: [JointDescription; 6] = [
    JointDescription {
        name: "vv",
        column: "vv_deg",
        symbol: "VV",
        long_name: "VarusValgus",
        title: "Varus\u{2013}valgus",
        positive: "insert varus",
        decimals: 3,
        least_span: 0.5,
        axis: Axis::About(X),
        moves: MovedBody::Insert,
        settling: Settling::DrivenWithoutLoad,
        is_zeroed: false,
        inertia: MOMENT_OF_INERTIA_TONNE_MM2,
        damping: DAMPING_NMM_S_PER_RAD,
        motion: None,
        load: Loading::Free,
    },
    JointDescription {
        name: "ie",
        column: "ie_deg",
        symbol: "IE",
        long_name: "InternalExternal",
        title: "Internal\u{2013}external",
        positive: "insert internal",
        decimals: 3,
        least_span: 0.5,
        axis: Axis::About(Y),
        moves: MovedBody::Insert,
        settling: Settling::HeldAtZero,
        is_zeroed: false,
        inertia: MOMENT_OF_INERTIA_TONNE_MM2,
        damping: DAMPING_NMM_S_PER_RAD,
        motion: Some(&IE_MOTION),
        load: Loading::By(&IE_TORQUE),
    },
    JointDescription {
        name: "ml",
        column: "ml_mm",
        symbol: "ML",
        long_name: "MedioLateral",
        title: "Medio-lateral",
        positive: "insert lateral",
        decimals: 3,
        least_span: 0.5,
        axis: Axis::Along(Z),
        moves: MovedBody::Insert,
        settling: Settling::DrivenWithoutLoad,
        is_zeroed: true,
        inertia: MASS_TONNE,
        damping: DAMPING_N_S_PER_MM,
        motion: None,
        load: Loading::Free,
    },
    JointDescription {
        name: "ap",
        column: "ap_mm",
        symbol: "AP",
        long_name: "AnteroPosterior",
        title: "Anterior\u{2013}posterior",
        positive: "insert anterior",
        decimals: 3,
        least_span: 0.5,
        axis: Axis::Along(X),
        moves: MovedBody::Insert,
        settling: Settling::Free,
        is_zeroed: true,
        inertia: MASS_TONNE,
        damping: DAMPING_N_S_PER_MM,
        motion: Some(&AP_MOTION),
        load: Loading::By(&AP_FORCE),
    },
    JointDescription {
        name: "is",
        column: "is_mm",
        symbol: "IS",
        long_name: "InferoSuperior",
        title: "Superior\u{2013}inferior",
        positive: "superior",
        decimals: 3,
        least_span: 0.1,
        axis: Axis::Along(Y),
        moves: MovedBody::Femur,
        settling: Settling::Driven,
        is_zeroed: true,
        inertia: MASS_TONNE,
        damping: DAMPING_N_S_PER_MM,
        motion: None,
        load: Loading::By(&AXIAL_FORCE),
    },
    JointDescription {
        name: "flexion",
        column: "flexion_deg",
        symbol: "flexion",
        long_name: "Flexion",
        title: "Flexion",
        positive: "flexion",
        decimals: 2,
        least_span: 1.0,
        axis: Axis::AboutFemur(Z),
        moves: MovedBody::Femur,
        settling: Settling::Driven,
        is_zeroed: false,
        inertia: MOMENT_OF_INERTIA_TONNE_MM2,
        damping: DAMPING_NMM_S_PER_RAD,
        motion: Some(&FLEXION_MOTION),
        load: Loading::None,
    },
];

/// Varus-valgus of the insert, rad, + varus.
pub const VV: JointIndex = JointIndex::named("vv", &JOINTS);
/// Internal-external rotation of the insert, rad, + internal.
pub const IE: JointIndex = JointIndex::named("ie", &JOINTS);
/// Medio-lateral translation of the insert, mm, + lateral.
pub const ML: JointIndex = JointIndex::named("ml", &JOINTS);
/// Antero-posterior translation of the insert, mm, + anterior.
pub const AP: JointIndex = JointIndex::named("ap", &JOINTS);
/// Infero-superior translation of the femur, mm, + superior.
pub const IS: JointIndex = JointIndex::named("is", &JOINTS);
/// Flexion of the femur, rad, + flexion.
pub const FLEXION: JointIndex = JointIndex::named("flexion", &JOINTS);

/// The region of a surface on the side of the other knee.
pub const MEDIAL: usize = 0;
/// The region of a surface away from the other knee.
pub const LATERAL: usize = 1;

/// The knee: six joints, two regions.
pub static KNEE: Mechanism = Mechanism {
    joints: JOINTS,
    in_files: [AP, IE, ML, VV, IS, FLEXION],
    channels: &[
        &AXIAL_FORCE,
        &FLEXION_MOTION,
        &AP_FORCE,
        &IE_TORQUE,
        &AP_MOTION,
        &IE_MOTION,
    ],
    columns: &[
        CycleQuantity::Position(FLEXION),
        CycleQuantity::AxialForce,
        CycleQuantity::Position(AP),
        CycleQuantity::Position(IE),
        CycleQuantity::Position(ML),
        CycleQuantity::Position(VV),
        CycleQuantity::Position(IS),
        CycleQuantity::ContactArea,
        CycleQuantity::PeakPressure,
        CycleQuantity::RegionForce(MEDIAL),
        CycleQuantity::RegionForce(LATERAL),
    ],
    regions: &[
        Region {
            name: "medial",
            label: "Medial",
            column: "medial_force_n",
            title: "Medial force",
        },
        Region {
            name: "lateral",
            label: "Lateral",
            column: "lateral_force_n",
            title: "Lateral force",
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::MAX_REGIONS;

    #[test]
    fn columns_are_named_after_joint_and_unit() {
        for joint in &KNEE.joints {
            let expected = format!("{}_{}", joint.name, joint.kind().unit());
            assert_eq!(joint.column, expected);
        }
        for region in KNEE.regions {
            assert_eq!(region.column, format!("{}_force_n", region.name));
        }
        assert!(KNEE.regions.len() <= MAX_REGIONS);
    }

    #[test]
    fn every_joint_and_every_waveform_is_listed_once() {
        for index in JointIndex::ALL {
            assert_eq!(KNEE.named(KNEE.joint(index).name), Some(index));
            assert!(KNEE.in_files.contains(&index));
            assert!(KNEE.columns.contains(&CycleQuantity::Position(index)));
        }
        let taken = KNEE.joints.iter();
        let taken = taken.flat_map(|joint| [joint.motion, joint.load_channel()]);
        let taken: Vec<_> = taken.flatten().collect();
        assert_eq!(taken.len(), KNEE.channels.len());
        for channel in taken {
            assert_eq!(KNEE.channel(channel.name), Some(channel));
        }
    }

    #[test]
    fn axes_are_unit_vectors() {
        for joint in &KNEE.joints {
            let (Axis::Along(axis) | Axis::About(axis) | Axis::AboutFemur(axis)) = joint.axis;
            assert_eq!(axis.iter().map(|x| x * x).sum::<f64>(), 1.0);
        }
    }
}
