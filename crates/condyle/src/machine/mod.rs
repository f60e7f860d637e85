//! The simulator: joints, waveforms, restraints, and equilibrium in time.
//!
//! A machine is a table of six joints ([`Mechanism`]; the [`knee`] is one), a drive for each of them, and
//! springs. It sees a contact interface, never a mesh.

mod assembly;
mod balance;
mod chain;
mod cycle;
mod explicit;
mod implicit;
mod joint;
pub mod knee;
mod mechanism;
mod newton;
mod settle;
mod simulator;
mod state;
mod waveform;

pub use assembly::{Drive, Joint, Machine, Spring};
pub use chain::{Chain, Configuration};
pub use cycle::{Cycle, CycleError, Integration, TimeSettings};
pub use joint::{
    Axis, Channel, ChannelUnit, JointDescription, JointIndex, JointKind, Loading, MovedBody,
    Settling,
};
pub use mechanism::{CycleQuantity, CycleRow, Mechanism, Region};
pub use settle::{NotSettled, settle};
pub use simulator::Simulator;
pub use state::{Kinematics, MachineState, SolverCounters, WarmStart};
pub use waveform::{Interpolation, Knot, Waveform, WaveformError, low_passed, without_drift};
