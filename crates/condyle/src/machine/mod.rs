//! The simulator: joints, waveforms, restraints, and equilibrium in time.
//!
//! A machine is a table of six joints ([`Mechanism`]; the [`knee`] is one), what drives each of them, and
//! springs. It sees a contact interface, never a mesh.

mod assembly;
mod balance;
mod chain;
mod channel;
mod counters;
mod cycle;
mod cycle_error;
mod cycle_row;
mod differences;
mod driving;
mod explicit;
mod implicit;
mod joint;
mod joint_index;
mod joint_kind;
mod joint_vectors;
mod kinematics;
pub mod knee;
mod knot;
mod mechanism;
mod newton;
mod readings;
mod repetition;
mod settle;
mod signal;
mod simulator;
mod spline;
mod spring;
mod stable_step;
mod state;
mod step_error;
mod time_settings;
mod warm_start;
mod waveform;
mod waveform_error;

pub use assembly::{Drive, Joint, Machine};
pub use chain::{Chain, Configuration};
pub use channel::{Channel, ChannelUnit};
pub use counters::SolverCounters;
pub use cycle::Cycle;
pub use cycle_error::CycleError;
pub use cycle_row::CycleRow;
pub use joint::{Axis, JointDescription, Loading, MovedBody, Settling};
pub use joint_index::JointIndex;
pub use joint_kind::JointKind;
pub use kinematics::Kinematics;
pub use knot::Knot;
pub use mechanism::{CycleQuantity, Mechanism, Region};
pub use readings::Readings;
pub use settle::{NotSettled, settle};
pub use signal::{low_passed, without_drift};
pub use simulator::Simulator;
pub use spring::Spring;
pub use state::MachineState;
pub use time_settings::{Integration, TimeSettings};
pub use warm_start::WarmStart;
pub use waveform::{Interpolation, Waveform};
pub use waveform_error::WaveformError;
