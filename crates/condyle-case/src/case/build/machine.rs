//! The machine of each activity, in mm, N, s and rad.

use condyle::Vec3;
use condyle::evolve::Activity;
use condyle::machine::knee::{self, KNEE};
use condyle::machine::{
    Channel, Drive, JointDescription, JointIndex, JointKind, Machine, Spring, Waveform,
};

use crate::case::contents::Case;
use crate::case::drive::DriveWord;
use crate::case::frame::Side;
use crate::case::machine as case;
use crate::case::machine::{Freedom, StiffnessOf};
use crate::case::rig::Rig;

const TONNE_PER_KG: f64 = 1e-3;
const TONNE_MM2_PER_KG_M2: f64 = 1e3;
const NMM_PER_NM: f64 = 1e3;

impl case::Machine {
    /// Builds the machine around an insert whose dishes are lowest at `low_point_mm`; ligaments are of a joint of `side`.
    pub(super) fn build(&self, low_point_mm: Vec3, side: Side) -> Machine {
        let settings = &self.settings;
        let mut machine = Machine::new(&KNEE);
        for index in JointIndex::ALL {
            let (joint, freedom) = (machine.joint_mut(index), self.freedoms.get(index));
            joint.drive = self.drive(joint.description, freedom);
            (joint.inertia, joint.damping) = match joint.description.kind() {
                JointKind::Translation => (freedom.inertia * TONNE_PER_KG, freedom.damping),
                JointKind::Rotation => (
                    freedom.inertia * TONNE_MM2_PER_KG_M2,
                    freedom.damping * NMM_PER_NM,
                ),
            };
        }
        machine.joint_mut(knee::VV).axis_point_mm = Vec3::new(
            0.0,
            low_point_mm.y - settings.vv_axis_below_mm,
            -settings.vv_axis_medial_mm,
        );
        machine.joint_mut(knee::IE).axis_point_mm =
            Vec3::new(settings.ie_axis_anterior_mm, 0.0, 0.0);
        let springs = &self.springs;
        // Two springs act in parallel: each of a pair has half of its stiffness.
        let share = match springs.stiffness_of {
            StiffnessOf::Pair => 0.5,
            StiffnessOf::Each => 1.0,
        };
        let spring = |side: f64| Spring {
            along: knee::AP,
            about: knee::IE,
            offset_mm: side * springs.lateral_offset_mm,
            positive_stiffness: share * springs.anterior_n_per_mm,
            negative_stiffness: share * springs.posterior_n_per_mm,
            free_play: springs.free_play_mm,
            rest: 0.0,
        };
        machine.springs = vec![spring(1.0), spring(-1.0)];
        let ligaments = self.ligaments.iter();
        machine.ligaments = ligaments.map(|ligament| ligament.build(side)).collect();
        machine.frequency_hz = settings.frequency_hz;
        machine
    }

    fn drive(&self, joint: &JointDescription, freedom: &Freedom) -> Drive {
        match freedom.drive {
            DriveWord::Prescribed => Drive::Prescribed(self.inside(joint.motion)),
            DriveWord::Loaded => Drive::Loaded(self.inside(joint.load_channel())),
            DriveWord::Locked => {
                let unit = joint.kind().file_unit_in_solver();
                Drive::Locked(freedom.locked_at * unit)
            }
        }
    }

    /// Returns the waveform of a channel in mm, rad, N or N mm with the sign of its joint; zero without a channel.
    fn inside(&self, channel: Option<&'static Channel>) -> Waveform {
        let given = channel.and_then(|channel| Some((channel, self.waveforms.get(channel)?)));
        let Some((channel, waveform)) = given else {
            return Waveform::constant(0.0);
        };
        let (settings, waveform) = (&self.settings, waveform.clone());
        // Offset and signs of the machine are in the unit of files.
        let adjusted = match channel.name {
            "flexion" => waveform.shifted(settings.flexion_offset_deg),
            "ap_force" => waveform.scaled(settings.ap_force_sign.0),
            "ie_torque" => waveform.scaled(settings.ie_torque_sign.0),
            _ => waveform,
        };
        adjusted.scaled(channel.factor())
    }
}

pub(super) fn start_flexion_rad(machine: &Machine) -> f64 {
    if *machine.mechanism != KNEE {
        return 0.0;
    }
    match &machine.joint(knee::FLEXION).drive {
        Drive::Prescribed(flexion) => flexion.at(0.0).0,
        Drive::Locked(at) => *at,
        Drive::Loaded(_) => 0.0,
    }
}

impl Case {
    pub(in crate::case) fn built_activities(&self, low_point_mm: Vec3) -> Vec<Activity> {
        let side = self.heading.side;
        let build = |machine: &case::Machine, rig: &Option<Rig>| match rig {
            Some(rig) => rig.build(side),
            None => machine.build(low_point_mm, side),
        };
        if self.activities.is_empty() {
            let machine = build(&self.machine, &self.machine.rig);
            return vec![Activity::only("gait", machine)];
        }
        let activities = self.activities.iter().zip(self.activities.shares());
        let built = activities.map(|(activity, share)| {
            let (mut machine, keys) = (self.machine.clone(), &activity.keys);
            machine.waveforms = activity.waveforms.clone();
            let own = &mut machine.settings;
            own.frequency_hz = keys.frequency_hz.unwrap_or(own.frequency_hz);
            own.flexion_offset_deg = keys.flexion_offset_deg.unwrap_or(own.flexion_offset_deg);
            own.ap_force_sign = keys.ap_force_sign.unwrap_or(own.ap_force_sign);
            own.ie_torque_sign = keys.ie_torque_sign.unwrap_or(own.ie_torque_sign);
            Activity {
                name: keys.name.clone(),
                machine: build(&machine, &activity.rig),
                share,
            }
        });
        built.collect()
    }

    #[cfg(feature = "file-system")]
    pub(in crate::case) fn start_flexion_rad(&self) -> f64 {
        start_flexion_rad(&self.built_activities(Vec3::zeros())[0].machine)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn machine(text: &str) -> Machine {
        let case = Case::parse(text, "case.toml", Path::new("")).unwrap();
        case.machine.build(Vec3::new(0.0, 1.0, 23.0), Side::Right)
    }

    fn driven(machine: &Machine, joint: JointIndex, phase: f64) -> f64 {
        match &machine.joint(joint).drive {
            Drive::Prescribed(waveform) | Drive::Loaded(waveform) => waveform.at(phase).0,
            Drive::Locked(at) => *at,
        }
    }

    #[test]
    fn verify_units_and_signs_of_force_control() {
        let machine = machine("");
        assert_eq!(driven(&machine, knee::IS, 0.13), -2600.3);
        assert_eq!(driven(&machine, knee::AP, 0.05), -265.0);
        assert_eq!(driven(&machine, knee::IE, 0.5), 5900.0);
        let flexion = driven(&machine, knee::FLEXION, 0.7);
        assert!((flexion - 51f64.to_radians()).abs() < 1e-12);
        assert!((start_flexion_rad(&machine) + 7f64.to_radians()).abs() < 1e-12);
        assert_eq!(driven(&machine, knee::ML, 0.3), 0.0);
        let vv_axis = machine.joint(knee::VV).axis_point_mm;
        assert_eq!((vv_axis.y, vv_axis.z), (-19.0, -5.0));
        assert_eq!(machine.joint(knee::AP).inertia, 0.005);
        assert_eq!(machine.joint(knee::IE).inertia, 10.0);
        assert_eq!(machine.joint(knee::VV).damping, 200.0);
    }

    #[test]
    fn signs_turn_force_and_torque_round() {
        let machine = machine("[machine]\nap_force_sign = -1\nie_torque_sign = -1\n");
        assert_eq!(driven(&machine, knee::AP, 0.05), 265.0);
        assert_eq!(driven(&machine, knee::IE, 0.5), -5900.0);
    }

    #[test]
    fn displacement_control_prescribes_ap_and_ie() {
        let machine = machine("[machine]\npreset = \"stanmore-displacement\"\n");
        let ap = &machine.joint(knee::AP).drive;
        assert!(matches!(ap, Drive::Prescribed(_)));
        assert!((driven(&machine, knee::AP, 0.65) + 5.2).abs() < 1e-9);
        let ie = driven(&machine, knee::IE, 0.0);
        assert!((ie + 1.57f64.to_radians()).abs() < 1e-12);
    }

    #[test]
    fn a_pair_of_springs_shares_its_stiffness() {
        let pair = machine("").springs;
        let each = machine("[machine.springs]\nstiffness_of = \"each\"\n").springs;
        let stiffness = |springs: &[Spring]| -> f64 {
            springs.iter().map(|spring| spring.negative_stiffness).sum()
        };
        assert_eq!((stiffness(&pair), stiffness(&each)), (33.8, 67.6));
        assert_eq!(pair[0].offset_mm, -pair[1].offset_mm);
    }

    #[test]
    fn a_locked_freedom_stays_where_it_is_put() {
        let locked = "drive = \"locked\"\nlocked_at_deg = 3.0\n";
        let machine = machine(&format!("[machine.freedoms.vv]\n{locked}"));
        assert_eq!(
            machine.joint(knee::VV).drive,
            Drive::Locked(3f64.to_radians())
        );
    }
}
