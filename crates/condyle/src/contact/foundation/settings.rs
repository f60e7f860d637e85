//! How an elastic foundation presses and rubs, and how that is computed.

use crate::contact::{broad_phase::Search, pressed::Coulomb, pressure_law::PressureLaw};

/// The law of an elastic layer on a rigid base under a rigid femur.
///
/// Every node's share of the articulating surface presses with the law's pressure at its mean
/// overclosure, along the femur's normal there, and rubs with regularised Coulomb friction,
///
/// $$ \mathbf f = p A \left( \mathbf n + \mu \frac{\mathbf v_t}{\sqrt{v_t^2 + v_0^2}} \right). $$
///
/// Shares at the edge of contact count with the part of them that presses. Limits: neighbours do not
/// feel each other, so a foundation does not match Hertz, and edge loading is over-estimated
/// (Halloran 2005).
#[derive(Clone, Debug, PartialEq)]
pub struct Foundation {
    /// Pressure from overclosure.
    pub pressure: PressureLaw,
    /// Coulomb's coefficient of friction, mu.
    pub friction: f64,
    /// Speed at which friction has reached 71 % of its full value, v0, mm/s, > 0.
    ///
    /// Smaller is nearer to Coulomb's stick and slip; larger lets parts that should stick creep, and
    /// is easier to solve.
    pub slip_tolerance_mm_per_s: f64,
    /// How the nodes that may touch are found; no answer depends on it.
    pub search: Search,
    /// Motion up to which a sample of the femur is extrapolated to second order rather than taken anew,
    /// mm; 0 takes every sample anew.
    ///
    /// This is the one approximation of the search. The second derivatives of a mesh's field vary by
    /// some 0.003/mm from cell to cell: at 0.02 mm the gap errs by less than a millionth of a
    /// millimetre, and the force by a hundred-thousandth.
    pub sample_reuse_mm: f64,
}

impl Foundation {
    /// The motion up to which samples are extrapolated unless said otherwise, mm: most of Newton's
    /// corrections are shorter, so that a mesh's field is mostly sampled once an increment.
    pub const SAMPLE_REUSE_MM: f64 = 0.02;

    /// A foundation that is computed the quick way.
    pub fn new(pressure: PressureLaw, friction: f64, slip_tolerance_mm_per_s: f64) -> Self {
        Self {
            pressure,
            friction,
            slip_tolerance_mm_per_s,
            search: Search::default(),
            sample_reuse_mm: Self::SAMPLE_REUSE_MM,
        }
    }

    /// Its friction.
    pub(super) fn coulomb(&self) -> Coulomb {
        Coulomb {
            coefficient: self.friction,
            slip_tolerance_mm_per_s: self.slip_tolerance_mm_per_s,
        }
    }
}
