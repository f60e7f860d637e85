//! The knee simulator as a table.
//!
//! The insert carries VV nearest to it, then IE, ML and AP towards the frame; the femur flexes on a carriage that moves
//! IS. Case keys, result columns, messages and pages use these six descriptions.

use super::{
    Axis, Channel,
    ChannelUnit::{self, Degree, Millimetre, Newton, NewtonMetre},
    CycleQuantity, JointDescription, JointIndex, Loading, Mechanism, MovedBody, Region, Settling,
    TestedJoint,
};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Mass that translates with a joint, tonne: that of a carriage, approximate; no source gives it.
pub const MASS_TONNE: f64 = 5e-3;
/// Moment of inertia that rotates with a joint, tonne mm2: that mass at a radius of 45 mm.
pub const MOMENT_OF_INERTIA_TONNE_MM2: f64 = 10.0;
/// Viscous damping of a translation, N s/mm: with that mass 0.36 and 0.79 of critical on the springs.
pub const DAMPING_N_S_PER_MM: f64 = 0.3;
/// Viscous damping of a rotation, N mm s/rad: with that inertia 0.19 and 0.42 of critical on the springs.
pub const DAMPING_NMM_S_PER_RAD: f64 = 200.0;

const fn channel(
    name: &'static str,
    about: &'static str,
    unit: ChannelUnit,
    sign: f64,
    [least, most]: [f64; 2],
) -> Channel {
    Channel {
        name,
        about,
        unit,
        sign,
        least,
        most,
    }
}

/// Compression of the joint; it pushes the femur down, against IS.
pub static AXIAL_FORCE: Channel = channel(
    "axial_force",
    "Compression of the joint.",
    Newton,
    -1.0,
    [0.0, 20_000.0],
);
/// Flexion of the femur.
pub static FLEXION_MOTION: Channel = channel(
    "flexion",
    "Flexion of the femur, + flexion.",
    Degree,
    1.0,
    [-45.0, 180.0],
);
/// Antero-posterior force on the insert.
pub static AP_FORCE: Channel = channel(
    "ap_force",
    "AP force on the insert, + anterior.",
    Newton,
    1.0,
    [-5000.0, 5000.0],
);
/// Torque on the insert.
pub static IE_TORQUE: Channel = channel(
    "ie_torque",
    "Torque on the insert, + internal.",
    NewtonMetre,
    1.0,
    [-200.0, 200.0],
);
/// Antero-posterior motion of the insert.
pub static AP_MOTION: Channel = channel(
    "ap_motion",
    "AP motion of the insert, + anterior.",
    Millimetre,
    1.0,
    [-50.0, 50.0],
);
/// Internal-external rotation of the insert.
pub static IE_MOTION: Channel = channel(
    "ie_motion",
    "IE rotation of the insert, + internal.",
    Degree,
    1.0,
    [-90.0, 90.0],
);

/// The values that most joints share: those of a carriage that moves the insert along x.
const CARRIAGE: JointDescription = JointDescription {
    name: "",
    column: "",
    symbol: "",
    long_name: "",
    title: "",
    positive: "",
    decimals: 3,
    least_span: 0.5,
    axis: Axis::Along(X),
    moves: MovedBody::Insert,
    settling: Settling::DrivenWithoutLoad,
    is_zeroed: true,
    inertia: MASS_TONNE,
    damping: DAMPING_N_S_PER_MM,
    motion: None,
    load: Loading::Free,
};

/// The values that the rotations share.
const TURNTABLE: JointDescription = JointDescription {
    axis: Axis::About(X),
    is_zeroed: false,
    inertia: MOMENT_OF_INERTIA_TONNE_MM2,
    damping: DAMPING_NMM_S_PER_RAD,
    ..CARRIAGE
};

const JOINTS: [JointDescription; 6] = [
    JointDescription {
        name: "vv",
        column: "vv_deg",
        symbol: "VV",
        long_name: "VarusValgus",
        title: "Varus\u{2013}valgus",
        positive: "insert varus",
        ..TURNTABLE
    },
    JointDescription {
        name: "ie",
        column: "ie_deg",
        symbol: "IE",
        long_name: "InternalExternal",
        title: "Internal\u{2013}external",
        positive: "insert internal",
        axis: Axis::About(Y),
        settling: Settling::HeldAtZero,
        motion: Some(&IE_MOTION),
        load: Loading::By(&IE_TORQUE),
        ..TURNTABLE
    },
    JointDescription {
        name: "ml",
        column: "ml_mm",
        symbol: "ML",
        long_name: "MedioLateral",
        title: "Medio-lateral",
        positive: "insert lateral",
        axis: Axis::Along(Z),
        ..CARRIAGE
    },
    JointDescription {
        name: "ap",
        column: "ap_mm",
        symbol: "AP",
        long_name: "AnteroPosterior",
        title: "Anterior\u{2013}posterior",
        positive: "insert anterior",
        settling: Settling::Free,
        motion: Some(&AP_MOTION),
        load: Loading::By(&AP_FORCE),
        ..CARRIAGE
    },
    JointDescription {
        name: "is",
        column: "is_mm",
        symbol: "IS",
        long_name: "InferoSuperior",
        title: "Superior\u{2013}inferior",
        positive: "superior",
        least_span: 0.1,
        axis: Axis::Along(Y),
        moves: MovedBody::Counterface,
        settling: Settling::Driven,
        load: Loading::By(&AXIAL_FORCE),
        ..CARRIAGE
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
        axis: Axis::AboutCounterface(Z),
        moves: MovedBody::Counterface,
        settling: Settling::Driven,
        motion: Some(&FLEXION_MOTION),
        load: Loading::None,
        ..TURNTABLE
    },
];

/// Varus-valgus of the insert, rad, + varus.
pub const VV: JointIndex = JointIndex::ALL[0];
/// Internal-external rotation of the insert, rad, + internal.
pub const IE: JointIndex = JointIndex::ALL[1];
/// Medio-lateral translation of the insert, mm, + lateral.
pub const ML: JointIndex = JointIndex::ALL[2];
/// Antero-posterior translation of the insert, mm, + anterior.
pub const AP: JointIndex = JointIndex::ALL[3];
/// Infero-superior translation of the femur, mm, + superior.
pub const IS: JointIndex = JointIndex::ALL[4];
/// Flexion of the femur, rad, + flexion.
pub const FLEXION: JointIndex = JointIndex::ALL[5];

/// The region of a surface on the side of the other knee.
pub const MEDIAL: usize = 0;
/// The region of a surface away from the other knee.
pub const LATERAL: usize = 1;

/// The knee: six joints, two regions.
pub static KNEE: Mechanism = Mechanism {
    tests: TestedJoint::Knee,
    joints: JOINTS,
    in_files: &[AP, IE, ML, VV, IS, FLEXION],
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
    fn constants_are_the_places_of_the_named_joints() {
        let names = ["vv", "ie", "ml", "ap", "is", "flexion"];
        assert_eq!(
            names.map(|name| KNEE.named(name)),
            [VV, IE, ML, AP, IS, FLEXION].map(Some)
        );
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
            let (Axis::Along(axis) | Axis::About(axis) | Axis::AboutCounterface(axis)) = joint.axis;
            assert_eq!(axis.iter().map(|x| x * x).sum::<f64>(), 1.0);
        }
    }
}
