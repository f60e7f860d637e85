//! Studies over runs of a case.

mod converge;
mod converge_files;
mod converge_plan;
mod observed_order;

pub use converge::{
    ConvergeHappening, ConvergeOptions, Converged, Convergence, Point, QUANTITIES, Quantity,
    converge,
};
pub use converge_plan::{ConvergeError, ConvergePlan, Planned};
pub use observed_order::{Extrapolation, extrapolate};
