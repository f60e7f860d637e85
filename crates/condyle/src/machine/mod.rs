//! The simulator: freedoms, waveforms, restraints, and equilibrium in time.
//!
//! It sees a contact interface, never a mesh.

mod balance;
mod chain;
mod cycle;
mod explicit;
mod freedom;
mod integrator;
mod precedent;
mod restraint;
mod settle;
mod time_settings;
mod waveform;

pub use balance::Kinematics;
pub use chain::{Chain, Configuration};
pub use cycle::{Cycle, CycleError, CycleRow, Simulator};
pub use freedom::{Drive, FREEDOMS, Freedom, FreedomSettings, Machine};
pub use integrator::{Effort, MachineState};
pub use precedent::Precedent;
pub use restraint::ApSpring;
pub use settle::{NotSettled, settle};
pub use time_settings::{Integration, TimeSettings};
pub use waveform::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
