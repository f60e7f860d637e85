//! The settings of a contact patch, and the law of friction among them.

use crate::contact::broad_phase::Search;

/// The settings that the contacts of all laws have in common.
#[derive(Clone, Copy)]
pub(crate) struct ContactSettings {
    /// Regularised friction.
    pub friction: Coulomb,
    pub search: Search,
    /// Motion up to which a sample of the femur is extrapolated, mm.
    pub sample_reuse_mm: f64,
}

/// Coulomb's law of friction, regularised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coulomb {
    pub coefficient: f64,
    /// Speed at which friction has reached 71 % of its full value, v0, mm/s, > 0.
    pub slip_tolerance_mm_per_s: f64,
}
