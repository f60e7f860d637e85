//! The simulator: joints, waveforms, restraints, and equilibrium in time.
//!
//! A machine is a table of six joints ([`Mechanism`]; the [`knee`] is one), a drive for each of them,
//! springs and ligaments. It sees a contact interface, never a mesh.

mod assembly;
mod balance;
mod chain;
mod contact_energy;
mod cycle;
mod explicit;
mod implicit;
pub mod knee;
mod ligament;
mod mechanism;
mod settle;
mod simulator;
mod waveform;

pub use assembly::{Drive, Joint, Machine, Spring};
pub use chain::{Chain, Configuration};
pub(crate) use cycle::HEAVY;

pub use cycle::{
    Cycle, CycleError, Integration, Kinematics, MachineState, SolverCounters, TimeSettings,
    WarmStart,
};
pub use ligament::{Ligament, SlackLength};
pub use mechanism::{
    Axis, Channel, ChannelUnit, CycleQuantity, CycleRow, JointDescription, JointIndex, JointKind,
    Loading, Mechanism, MovedBody, Region, Settling, TestedJoint,
};
pub(crate) use settle::settle_from;
pub use settle::{NotSettled, settle};
pub use simulator::Simulator;
pub use waveform::{
    Interpolation, Knot, Waveform, WaveformError, extremes, low_passed, without_drift,
};
