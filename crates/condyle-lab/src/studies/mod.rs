//! Studies over runs of a case.

pub mod calibrate;
mod chance;
mod converge;
mod converge_files;
mod converge_plan;

mod many_runs;
mod observed_order;
pub mod sensitivity;
pub mod study;
mod table;
pub mod uncertainty;

pub use converge::{
    ConvergeHappening, ConvergeOptions, Converged, Convergence, Listener, Point, QUANTITIES,
    Quantity, converge,
};
pub use converge_plan::{ConvergeError, ConvergePlan, Planned};
pub use observed_order::{Extrapolation, extrapolate};
