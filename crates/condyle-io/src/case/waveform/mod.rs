//! From a table such as `[machine.flexion]` to a periodic waveform in the unit of its key.

mod join;
mod keys;
mod points;
mod read;
mod reason;
mod samples;

pub use keys::InterpolationWord;
pub use reason::WaveformReason;

pub(super) use keys::{DEFAULT_WAVEFORM, WaveformSource, knots_key, waveform_keys, ways};
pub(super) use read::read;
