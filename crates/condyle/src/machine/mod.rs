//! The simulator: freedoms, waveforms, restraints, and equilibrium in time.
//!
//! It sees a contact interface, never a mesh.

mod balance;
mod chain;
mod cycle;
mod explicit;
mod freedom;
mod integrator;
mod joint_numbers;
mod restraint;
mod settle;
mod time_settings;
mod warm_start;
mod waveform;

pub use balance::Kinematics;
pub use chain::{Chain, Configuration};
pub use cycle::{Cycle, CycleError, CycleRow, Simulator};
pub use freedom::{Drive, FREEDOMS, Freedom, FreedomSettings, Machine};
pub use integrator::{MachineState, SolverCounters};
pub use restraint::ApSpring;
pub use settle::{NotSettled, settle};
pub use time_settings::{Integration, TimeSettings};
pub use warm_start::WarmStart;
pub use waveform::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
