//! Why points make no waveform.

use condyle::machine::WaveformError;
use thiserror::Error;

use crate::config::Reason;

/// Points that make no waveform.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("[{section}]: {error}")]
pub struct WaveformReason {
    /// The table of the waveform.
    pub section: String,
    /// Why.
    pub error: WaveformError,
}

impl Reason for WaveformReason {
    fn advice(&self) -> Option<String> {
        let may_drift = matches!(self.error, WaveformError::Seam { .. });
        may_drift.then(|| "or, for a measured cycle, set `remove_drift = true`".to_owned())
    }
}
