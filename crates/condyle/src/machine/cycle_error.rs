//! Why a cycle was not solved.

use thiserror::Error;

use super::{Mechanism, Readings, explicit::NoStep, implicit::NotConverged};

/// Why a cycle was not solved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CycleError {
    /// An increment that does not converge even in the smallest steps.
    #[error(
        "the machine finds no balance at {percent:.2} % of the cycle: {residual_n:.3e} N are left over at {readings}; \
         check loads and springs there, or use more increments"
    )]
    NotConverged {
        /// Place in the cycle, %.
        percent: f64,
        /// Where the joints are at the last iteration.
        readings: Readings,
        /// Length of what is left out of balance, N.
        residual_n: f64,
    },
    /// Explicit steps whose motion left all bounds.
    #[error(
        "explicit steps leave all bounds at {percent:.2} % of the cycle, past {readings}; where friction rises steeply \
         with the speed or the load jumps no step is short enough: take a larger slip_tolerance_mm_per_s, a shorter explicit_step_s, or \
         integrator = \"implicit\""
    )]
    Unstable {
        /// Place in the cycle, %.
        percent: f64,
        /// Where the joints were before it.
        readings: Readings,
    },
    /// Explicit steps of a joint that weighs nothing.
    #[error(
        "the explicit integrator needs inertia on every loaded freedom, and {joint} has none; give it some, or \
         take the implicit integrator"
    )]
    NoInertia {
        /// Which joint, by its long name.
        joint: &'static str,
    },
}

impl CycleError {
    /// That of an implicit step which was given up.
    pub(super) fn of_implicit(mechanism: &Mechanism, failed: &NotConverged) -> Self {
        Self::NotConverged {
            percent: 100.0 * failed.phase,
            readings: Readings::new(mechanism, &failed.positions),
            residual_n: failed.residual_n,
        }
    }

    /// That of explicit steps which ended early.
    pub(super) fn of_explicit(mechanism: &Mechanism, failed: &NoStep) -> Self {
        match failed {
            NoStep::NoInertia(index) => Self::NoInertia {
                joint: mechanism.joint(*index).long_name,
            },
            NoStep::Unstable { phase, positions } => Self::Unstable {
                percent: 100.0 * phase,
                readings: Readings::new(mechanism, positions),
            },
        }
    }
}
