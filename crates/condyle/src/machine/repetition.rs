//! Whether a cycle repeats itself.

use super::{Joint, JointKind, Machine, MachineState, TimeSettings};

/// What counts as the same motion again.
pub(super) struct Repetition<'a> {
    machine: &'a Machine,
    time: &'a TimeSettings,
    /// Rates count by how far they lead in this time, s.
    lead_s: f64,
}

impl<'a> Repetition<'a> {
    /// Repetition within the tolerances of `time`; rates count by how far they lead in an increment.
    pub fn new(machine: &'a Machine, time: &'a TimeSettings) -> Self {
        let lead_s = time.increment_s(machine.frequency_hz);
        Self {
            machine,
            time,
            lead_s,
        }
    }

    /// Whether the machine is where it was at `earlier` and moves as it did.
    pub fn is_met(&self, state: &MachineState, earlier: &MachineState) -> bool {
        let repeats = |(j, joint): (usize, &Joint)| {
            let apart = (state.now.positions[j] - earlier.now.positions[j]).abs();
            let parting = (state.now.rates[j] - earlier.now.rates[j]).abs() * self.lead_s;
            apart.max(parting) <= self.tolerance(joint)
        };
        self.machine.joints.iter().enumerate().all(repeats)
    }

    /// How far apart two positions of a joint may be, mm or rad.
    fn tolerance(&self, joint: &Joint) -> f64 {
        match joint.description.kind() {
            JointKind::Rotation => self.time.repeat_tolerance_rad,
            JointKind::Translation => self.time.repeat_tolerance_mm,
        }
    }
}
