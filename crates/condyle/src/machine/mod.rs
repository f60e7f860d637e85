//! The simulator: freedoms, waveforms, restraints, and equilibrium in time.

mod freedom;
mod restraint;
mod waveform;

pub use freedom::{Drive, FREEDOMS, Freedom, FreedomSettings, Machine};
pub use restraint::ApSpring;
pub use waveform::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
