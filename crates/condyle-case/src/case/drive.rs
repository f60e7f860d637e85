//! The drive of a joint.

use condyle::machine::{Channel, JointDescription};

use crate::config::*;

choice! {
    /// Drive of a freedom.
    DriveWord {
        /// Held at a position.
        Locked = "locked",
        /// Moved along a waveform of position.
        Prescribed = "prescribed",
        /// Free under a waveform of load, or under none.
        Loaded = "loaded",
    }
}

impl DriveWord {
    pub(super) fn fits(self, joint: &JointDescription) -> bool {
        match self {
            Self::Locked => true,
            Self::Prescribed => joint.motion.is_some(),
            Self::Loaded => joint.can_be_free(),
        }
    }

    pub(super) fn words_for(joint: &JointDescription) -> Vec<&'static str> {
        let drives = Self::ALL.iter().copied();
        drives
            .filter(|drive| drive.fits(joint))
            .map(Self::word)
            .collect()
    }

    /// Returns the waveform that the drive of a joint needs.
    pub(super) fn channel(self, joint: &JointDescription) -> Option<&'static Channel> {
        match self {
            Self::Locked => None,
            Self::Prescribed => joint.motion,
            Self::Loaded => joint.load_channel(),
        }
    }
}
