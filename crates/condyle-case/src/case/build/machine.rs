//! The machine of each activity, in mm, N, s and rad.

use condyle::Vec3;
use condyle::evolve::Activity;
use condyle::machine::knee::{self, KNEE};
use condyle::machine::{Channel, Drive, JointIndex, Machine, Waveform};

use crate::case::activity::shares;
use crate::case::contents::Case;
use crate::case::machine as case;
use crate::case::machine::{Freedom, FreedomKeys, Springs, StiffnessOf};
use crate::case::rig::Rig;
use crate::case::rig_joint::RigJointKeys;
use crate::case::rig_spring::OffsetSpring;

impl case::Machine {
    /// Returns the machine by joints: that of the case, or the knee simulator's with the keys of the case.
    fn by_joints(&self) -> Rig {
        if let Some(rig) = &self.rig {
            return rig.clone();
        }
        let settings = &self.settings;
        let mut rig = settings.preset.machine().clone();
        (rig.keys.frequency_hz, rig.keys.load_scale) = (settings.frequency_hz, settings.load_scale);
        for (joint, index) in rig.joints.iter_mut().zip(JointIndex::ALL) {
            let freedom = self.freedoms.get(index);
            freedom.set(&mut joint.keys);
            joint.waveform = self.waveform(freedom.drive.channel(KNEE.joint(index)));
            match index {
                knee::VV => {
                    let (below, medial) = (settings.vv_axis_below_mm, settings.vv_axis_medial_mm);
                    joint.keys.point_mm = Some([0.0, -below, -medial]);
                }
                knee::IE => joint.keys.point_mm = Some([settings.ie_axis_anterior_mm, 0.0, 0.0]),
                _ => {}
            }
        }
        for spring in &mut rig.springs {
            self.springs.set(spring);
        }
        rig.ligaments.clone_from(&self.ligaments);
        rig
    }

    /// Returns the waveform of a channel in the unit of files, with the sign of its joint.
    fn waveform(&self, channel: Option<&'static Channel>) -> Option<Waveform> {
        let (channel, settings) = (channel?, &self.settings);
        let waveform = self.waveforms.get(channel)?.clone();
        let adjusted = match channel.name {
            "flexion" => waveform.shifted(settings.flexion_offset_deg),
            "ap_force" => waveform.scaled(settings.ap_force_sign.0),
            "ie_torque" => waveform.scaled(settings.ie_torque_sign.0),
            _ => waveform,
        };
        Some(adjusted.scaled(channel.sign))
    }
}

impl Freedom {
    /// Sets drive, inertia and damping of a joint.
    fn set(&self, keys: &mut RigJointKeys) {
        keys.drive = self.drive;
        match &self.keys {
            FreedomKeys::Translation(own) => {
                keys.locked_at_mm = Some(own.locked_at_mm);
                keys.inertia_kg = Some(own.inertia_kg);
                keys.damping_n_s_per_mm = Some(own.damping_n_s_per_mm);
            }
            FreedomKeys::Rotation(own) => {
                keys.locked_at_deg = Some(own.locked_at_deg);
                keys.inertia_kg_m2 = Some(own.inertia_kg_m2);
                keys.damping_nm_s_per_rad = Some(own.damping_nm_s_per_rad);
            }
        }
    }
}

impl Springs {
    /// Sets one spring of the pair, which keeps its side.
    fn set(&self, spring: &mut OffsetSpring) {
        // Two springs act in parallel: each of a pair has half of its stiffness.
        let share = match self.stiffness_of {
            StiffnessOf::Pair => 0.5,
            StiffnessOf::Each => 1.0,
        };
        let both = [self.anterior_n_per_mm, self.posterior_n_per_mm];
        spring.stiffness_n_per_mm = both.map(|stiffness| share * stiffness);
        spring.offset_mm = spring.offset_mm.signum() * self.lateral_offset_mm;
        spring.free_play_mm = self.free_play_mm;
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
        let build = |rig: Rig| rig.build(low_point_mm, self.side_in_frame());
        if self.activities.is_empty() {
            let machine = build(self.machine.by_joints());
            return vec![Activity::only("gait", machine)];
        }
        let activities = self.activities.iter().zip(shares(&self.activities));
        let built = activities.map(|(activity, share)| {
            let (mut machine, keys) = (self.machine.clone(), &activity.keys);
            machine.rig.clone_from(&activity.rig);
            if let (Some(own), Some(all)) = (&mut machine.rig, &self.machine.rig) {
                own.keys.load_scale *= all.keys.load_scale;
                own.keys.motion_scale *= all.keys.motion_scale;
            }
            machine.waveforms = activity.waveforms.clone();
            let own = &mut machine.settings;
            own.frequency_hz = keys.frequency_hz.unwrap_or(own.frequency_hz);
            own.flexion_offset_deg = keys.flexion_offset_deg.unwrap_or(own.flexion_offset_deg);
            own.ap_force_sign = keys.ap_force_sign.unwrap_or(own.ap_force_sign);
            own.ie_torque_sign = keys.ie_torque_sign.unwrap_or(own.ie_torque_sign);
            Activity {
                name: keys.name.clone(),
                machine: build(machine.by_joints()),
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
    use crate::case::frame::Side;
    use condyle::machine::Spring;

    fn machine(text: &str) -> Machine {
        let case = Case::parse(text, "case.toml", Path::new("")).unwrap();
        let low_point_mm = Vec3::new(0.0, 1.0, 23.0);
        case.machine.by_joints().build(low_point_mm, Side::Right)
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
