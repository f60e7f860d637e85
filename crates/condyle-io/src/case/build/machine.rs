//! The simulator in mm, N, s, tonne and rad.

use condyle::Vec3;
use condyle::machine::{ApSpring, Drive, Freedom, FreedomSettings, Machine, Waveform};

use super::super::channel::Channel;
use super::super::machine as case;
use super::super::machine_keys::{DriveWord, Rotation, Springs, StiffnessOf, Translation};

/// A kilogram in tonnes.
const TONNE_PER_KG: f64 = 1e-3;
/// A kg m2 in tonne mm2.
const TONNE_MM2_PER_KG_M2: f64 = 1e3;
/// A newton metre in N mm.
const NMM_PER_NM: f64 = 1e3;

impl case::Machine {
    /// The machine around an insert whose dishes are lowest at `low_point_mm`.
    pub(super) fn build(&self, low_point_mm: Vec3) -> Machine {
        let (settings, rows) = (&self.settings, &self.freedoms);
        Machine {
            // The order of the chain, from the insert to the femur.
            freedoms: [
                self.rotation(&rows.vv, None, None),
                self.rotation(&rows.ie, Some(Channel::IeMotion), Some(Channel::IeTorque)),
                self.translation(&rows.ml, None, None),
                self.translation(&rows.ap, Some(Channel::ApMotion), Some(Channel::ApForce)),
                self.translation(&rows.is, None, Some(Channel::AxialForce)),
                self.rotation(&rows.flexion, Some(Channel::Flexion), None),
            ],
            ap_springs: springs(&self.springs),
            frequency_hz: settings.frequency_hz,
            vv_axis_mm: (
                low_point_mm.y - settings.vv_axis_below_mm,
                -settings.vv_axis_medial_mm,
            ),
            ie_axis_mm: (settings.ie_axis_anterior_mm, 0.0),
        }
    }

    fn translation(
        &self,
        row: &Translation,
        motion: Option<Channel>,
        load: Option<Channel>,
    ) -> FreedomSettings {
        FreedomSettings {
            drive: self.drive(row.drive, row.locked_at_mm, motion, load),
            inertia: row.inertia_kg * TONNE_PER_KG,
            damping: row.damping_n_s_per_mm,
        }
    }

    fn rotation(
        &self,
        row: &Rotation,
        motion: Option<Channel>,
        load: Option<Channel>,
    ) -> FreedomSettings {
        FreedomSettings {
            drive: self.drive(row.drive, row.locked_at_deg.to_radians(), motion, load),
            inertia: row.inertia_kg_m2 * TONNE_MM2_PER_KG_M2,
            damping: row.damping_nm_s_per_rad * NMM_PER_NM,
        }
    }

    fn drive(
        &self,
        word: Option<DriveWord>,
        locked_at: f64,
        motion: Option<Channel>,
        load: Option<Channel>,
    ) -> Drive {
        match word {
            Some(DriveWord::Prescribed) => Drive::Prescribed(self.inside(motion)),
            Some(DriveWord::Loaded) => Drive::Loaded(self.inside(load)),
            Some(DriveWord::Locked) | None => Drive::Locked(locked_at),
        }
    }

    /// The waveform of a channel in mm, rad, N or N mm, with the sign of its freedom; nothing
    /// pushes a freedom without one.
    fn inside(&self, channel: Option<Channel>) -> Waveform {
        let given = channel.and_then(|channel| Some((channel, self.waveforms.get(channel)?)));
        let Some((channel, waveform)) = given else {
            return Waveform::constant(0.0);
        };
        let (waveform, settings) = (waveform.clone(), &self.settings);
        match channel {
            // Compression is positive in the file and pushes the femur down, against IS.
            Channel::AxialForce => waveform.scaled(-1.0),
            Channel::Flexion => waveform
                .shifted(settings.flexion_offset_deg)
                .scaled(1f64.to_radians()),
            Channel::ApForce => waveform.scaled(settings.ap_force_sign.factor()),
            Channel::IeTorque => waveform.scaled(settings.ie_torque_sign.factor() * NMM_PER_NM),
            Channel::ApMotion => waveform,
            Channel::IeMotion => waveform.scaled(1f64.to_radians()),
        }
    }
}

/// A spring to each side of the IE axis.
fn springs(springs: &Springs) -> Vec<ApSpring> {
    let share = match springs.stiffness_of {
        StiffnessOf::Pair => 0.5,
        StiffnessOf::Each => 1.0,
    };
    let spring = |side: f64| ApSpring {
        lateral_offset_mm: side * springs.lateral_offset_mm,
        posterior_n_per_mm: share * springs.posterior_n_per_mm,
        anterior_n_per_mm: share * springs.anterior_n_per_mm,
        free_play_mm: springs.free_play_mm,
    };
    vec![spring(1.0), spring(-1.0)]
}

/// Flexion at the start of the cycle, rad.
pub(super) fn start_flexion_rad(machine: &Machine) -> f64 {
    match &machine.row(Freedom::Flexion).drive {
        Drive::Prescribed(flexion) => flexion.at(0.0).0,
        Drive::Locked(at) => *at,
        Drive::Loaded(_) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::case::Case;

    fn machine(text: &str) -> Machine {
        let case = Case::parse(text, "case.toml", Path::new("")).unwrap();
        case.machine.build(Vec3::new(0.0, 1.0, 23.0))
    }

    fn driven(machine: &Machine, freedom: Freedom, phase: f64) -> f64 {
        match &machine.row(freedom).drive {
            Drive::Prescribed(waveform) | Drive::Loaded(waveform) => waveform.at(phase).0,
            Drive::Locked(at) => *at,
        }
    }

    #[test]
    fn verify_units_and_signs_of_force_control() {
        let machine = machine("");
        assert_eq!(driven(&machine, Freedom::InferoSuperior, 0.13), -2600.3);
        assert_eq!(driven(&machine, Freedom::AnteroPosterior, 0.05), -265.0);
        assert_eq!(driven(&machine, Freedom::InternalExternal, 0.5), 5900.0);
        let flexion = driven(&machine, Freedom::Flexion, 0.7);
        assert!((flexion - 51f64.to_radians()).abs() < 1e-12);
        assert!((start_flexion_rad(&machine) + 7f64.to_radians()).abs() < 1e-12);
        assert_eq!(driven(&machine, Freedom::MedioLateral, 0.3), 0.0);
        assert_eq!(machine.vv_axis_mm, (-19.0, -5.0));
        assert_eq!(machine.row(Freedom::AnteroPosterior).inertia, 0.005);
        assert_eq!(machine.row(Freedom::InternalExternal).inertia, 10.0);
        assert_eq!(machine.row(Freedom::VarusValgus).damping, 200.0);
    }

    #[test]
    fn signs_turn_force_and_torque_round() {
        let machine = machine("[machine]\nap_force_sign = -1\nie_torque_sign = -1\n");
        assert_eq!(driven(&machine, Freedom::AnteroPosterior, 0.05), 265.0);
        assert_eq!(driven(&machine, Freedom::InternalExternal, 0.5), -5900.0);
    }

    #[test]
    fn displacement_control_prescribes_ap_and_ie() {
        let machine = machine("[machine]\npreset = \"stanmore-displacement\"\n");
        let ap = &machine.row(Freedom::AnteroPosterior).drive;
        assert!(matches!(ap, Drive::Prescribed(_)));
        assert!((driven(&machine, Freedom::AnteroPosterior, 0.65) + 5.2).abs() < 1e-9);
        let ie = driven(&machine, Freedom::InternalExternal, 0.0);
        assert!((ie + 1.57f64.to_radians()).abs() < 1e-12);
    }

    #[test]
    fn a_pair_of_springs_shares_its_stiffness() {
        let pair = machine("").ap_springs;
        let each = machine("[machine.springs]\nstiffness_of = \"each\"\n").ap_springs;
        let stiffness = |springs: &[ApSpring]| -> f64 {
            springs.iter().map(|spring| spring.posterior_n_per_mm).sum()
        };
        assert_eq!((stiffness(&pair), stiffness(&each)), (33.8, 67.6));
        assert_eq!(pair[0].lateral_offset_mm, -pair[1].lateral_offset_mm);
    }

    #[test]
    fn a_locked_freedom_stays_where_it_is_put() {
        let locked = "drive = \"locked\"\nlocked_at_deg = 3.0\n";
        let machine = machine(&format!("[machine.freedoms.vv]\n{locked}"));
        assert_eq!(
            machine.row(Freedom::VarusValgus).drive,
            Drive::Locked(3f64.to_radians())
        );
    }
}
