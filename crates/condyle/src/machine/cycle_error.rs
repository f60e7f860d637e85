//! Why a cycle was not solved.

use thiserror::Error;

use super::{Mechanism, Readings, explicit::NoStep, implicit::NotConverged};
use crate::contact::NotBorne;

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
    /// A load that presses the insert flat.
    #[error(
        "the load presses the insert flat at {percent:.2} % of the cycle: where plastic strain has come to {plastic_strain:.2} the \
         insert finds no balance; check the load, and [contact.deformable] yield_stress_mpa and its hardening, or take plasticity = \"none\""
    )]
    Flattened {
        /// Place in the cycle, %.
        percent: f64,
        /// The largest plastic strain when the search for a balance was given up.
        plastic_strain: f64,
    },
    /// A load under which an insert that rests on its tray finds no rest.
    #[error(
        "the load tips the insert off its tray at {percent:.2} % of the cycle: its backside finds no rest, and had moved by \
         {moved_mm:.2e} mm when the search was given up; check whether the load lies within the tray, or take [contact] \
         backside = \"bonded\""
    )]
    Tipped {
        /// Place in the cycle, %.
        percent: f64,
        /// Farthest that a point of the backside had moved by then, mm.
        moved_mm: f64,
    },
    /// A load under which the insert goes on flowing or slipping, however often it is put on again.
    #[error(
        "load and insert do not settle at {percent:.2} % of the cycle, even in the smallest steps: each of {turns} turns \
         moved the surface anew; use more increments, or check the load there"
    )]
    Unsettled {
        /// Place in the cycle, %.
        percent: f64,
        /// How often the load was put on.
        turns: u32,
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

    /// That of a load at a phase of the cycle.
    pub(super) fn not_borne(phase: f64, why: NotBorne) -> Self {
        let percent = 100.0 * phase;
        match why {
            NotBorne::Flattened { plastic_strain } => Self::Flattened {
                percent,
                plastic_strain,
            },
            NotBorne::Tipped { moved_mm } => Self::Tipped { percent, moved_mm },
        }
    }

    /// That of explicit steps which ended early.
    pub(super) fn of_explicit(mechanism: &Mechanism, failed: &NoStep) -> Self {
        match failed {
            NoStep::NoInertia(index) => Self::NoInertia {
                joint: mechanism.joint(*index).long_name,
            },
            NoStep::NotBorne { phase, why } => Self::not_borne(*phase, *why),
            NoStep::Unstable { phase, positions } => Self::Unstable {
                percent: 100.0 * phase,
                readings: Readings::new(mechanism, positions),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_insert_that_tips_says_where_and_what_to_do() {
        let tipped = NotBorne::Tipped { moved_mm: 12.0 };
        let said = CycleError::not_borne(0.25, tipped).to_string();
        for words in [
            "tips the insert off its tray at 25.00 %",
            "backside = \"bonded\"",
        ] {
            assert!(said.contains(words), "{said}");
        }
    }
}
