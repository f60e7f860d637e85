//! Springs of a machine file along a translation, beside the axis of a rotation.

use condyle::machine::{JointIndex, JointKind, Spring};

use super::rig_joint::RigJoint;
use crate::config::*;

settings! {
    /// A spring along a translation, beside the axis of a rotation: it acts on those of the two joints that are loaded, and not while the machine settles.
    OffsetSpring {
        /// Its name.
        name: String;
        /// Translation along which it acts.
        along: String;
        /// Rotation from whose axis its offset is measured.
        about: String;
        /// Distance from that axis: a positive rotation moves its attachment in the positive direction of the translation.
        offset_mm: f64, in within(-200.0, 200.0);
        /// Stiffness against positive and against negative motion.
        stiffness_n_per_mm: [f64; 2], in within(0.0, 10_000.0);
        /// Motion each way before it engages.
        free_play_mm: f64 = 0.0, in within(0.0, 100.0);
        /// Position of its attachment where it is without force.
        rest_mm: f64 = 0.0, in within(-100.0, 100.0);
    }
}

impl OffsetSpring {
    /// Returns the spring between two of `joints`, or the fault of a name that is not a joint of the kind it needs.
    pub(super) fn build(&self, joints: &[RigJoint]) -> Result<Spring, Fault> {
        let joint = |key: &str, name: &str, kind: JointKind| {
            let is_it = |joint: &RigJoint| joint.keys.name == name && joint.keys.kind == kind;
            let place = joints.iter().position(is_it).ok_or_else(|| {
                let wanted = kind.text().unwrap_or_default();
                let fits = joints.iter().filter(|joint| joint.keys.kind == kind);
                let names: Vec<&str> = fits.map(RigJoint::name).collect();
                Fault::new(
                    format!("the spring \"{}\" acts {key} \"{name}\", and no joint with kind = {wanted} has that name", self.name),
                    format!("write one of: {}", names.join(", ")),
                )
            })?;
            Ok(JointIndex::ALL[place])
        };
        let [positive_stiffness, negative_stiffness] = self.stiffness_n_per_mm;
        Ok(Spring {
            along: joint("along", &self.along, JointKind::Translation)?,
            about: joint("about", &self.about, JointKind::Rotation)?,
            offset_mm: self.offset_mm,
            positive_stiffness,
            negative_stiffness,
            free_play: self.free_play_mm,
            rest: self.rest_mm,
        })
    }
}
