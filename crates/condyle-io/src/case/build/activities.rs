//! What the machine of a case does in turn.

use condyle::Vec3;
use condyle::evolve::Activity;

use super::super::activity;
use super::super::contents::Case;
use super::super::machine::Machine;

/// What the only activity is called where the case names none.
const ONLY: &str = "gait";

impl Case {
    /// Every activity, of a machine around an insert whose dishes are lowest at `low_point_mm`.
    pub(super) fn built_activities(&self, low_point_mm: Vec3) -> Vec<Activity> {
        if self.activities.is_empty() {
            return vec![Activity::only(ONLY, self.machine.build(low_point_mm))];
        }
        let activities = self.activities.iter().zip(self.activities.shares());
        let built = activities.map(|(activity, share)| Activity {
            name: activity.keys.name.clone(),
            machine: self.machine.doing(activity).build(low_point_mm),
            share,
        });
        built.collect()
    }

    /// The machine of the first activity.
    #[cfg(feature = "file-system")]
    pub(super) fn first_machine(&self) -> Machine {
        let first = self.activities.iter().next();
        first.map_or_else(|| self.machine.clone(), |first| self.machine.doing(first))
    }
}

impl Machine {
    /// The same machine with the inputs of an activity.
    fn doing(&self, activity: &activity::Activity) -> Self {
        let (mut machine, keys) = (self.clone(), &activity.keys);
        machine.waveforms = activity.waveforms.clone();
        let own = &mut machine.settings;
        own.frequency_hz = keys.frequency_hz.unwrap_or(own.frequency_hz);
        own.flexion_offset_deg = keys.flexion_offset_deg.unwrap_or(own.flexion_offset_deg);
        own.ap_force_sign = keys.ap_force_sign.unwrap_or(own.ap_force_sign);
        own.ie_torque_sign = keys.ie_torque_sign.unwrap_or(own.ie_torque_sign);
        machine
    }
}
