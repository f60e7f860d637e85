//! What drives the joints at a phase of the cycle.

use super::{Drive, Machine, joint_vectors::JointForces};

impl Machine {
    /// Sets positions and rates of the joints that are locked or prescribed.
    pub(super) fn drive(&self, phase: f64, positions: &mut [f64; 6], rates: &mut [f64; 6]) {
        for (j, joint) in self.joints.iter().enumerate() {
            match &joint.drive {
                Drive::Locked(at) => (positions[j], rates[j]) = (*at, 0.0),
                Drive::Prescribed(waveform) => {
                    let (value, slope) = waveform.at(phase);
                    (positions[j], rates[j]) = (value, slope * self.frequency_hz);
                }
                Drive::Loaded(_) => {}
            }
        }
    }

    /// Load on every joint; 0 on those that are not loaded.
    pub(super) fn loads_at(&self, phase: f64) -> JointForces {
        JointForces::from_fn(|j| match &self.joints[j].drive {
            Drive::Loaded(waveform) => waveform.at(phase).0,
            Drive::Locked(_) | Drive::Prescribed(_) => 0.0,
        })
    }
}
