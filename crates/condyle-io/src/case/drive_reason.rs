//! Drives and waveforms that do not go together.

use thiserror::Error;

use crate::config::Reason;

/// Why a drive or a waveform cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DriveReason {
    /// A waveform of a freedom that is driven otherwise.
    #[error("[{section}] is given, but the {freedom} freedom is {drive}: the two contradict")]
    UnusedWaveform {
        /// The table of the waveform.
        section: String,
        /// The freedom it would drive.
        freedom: &'static str,
        /// How that is driven.
        drive: &'static str,
        /// The drive the waveform is for.
        wanted: &'static str,
    },
    /// A drive that no waveform exists for.
    #[error("the {freedom} freedom cannot be {drive}: a case has no waveform for that")]
    NoSuchDrive {
        /// The freedom.
        freedom: &'static str,
        /// As written.
        drive: &'static str,
        /// Drives it can have.
        drives: String,
    },
}

impl Reason for DriveReason {
    fn advice(&self) -> Option<String> {
        Some(match self {
            Self::UnusedWaveform {
                section, wanted, ..
            } => format!("remove [{section}], or make the freedom `drive = \"{wanted}\"`"),
            Self::NoSuchDrive { drives, .. } => format!("it can be {drives}"),
        })
    }
}
