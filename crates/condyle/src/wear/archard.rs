//! Archard's law.

use std::sync::Arc;

use super::law::{NodeWear, WearLaw, WearLawKind, first_times};
use super::{MM_PER_M, MeanCycle};
use crate::parameter::{Known, Parameter};

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "archard",
    about: "Depth per cycle = Kw sum of p |ds|.",
    known: Known::Read,
    parameters: &[Archard::WEAR_FACTOR],
    scaled: |constants, times| first_times(1, constants, times),
    make: |constants| {
        Arc::new(Archard {
            wear_factor_mm3_per_nm: constants[0],
        })
    },
};

/// Archard's law: $\text{depth per cycle} = K_w \sum p |\Delta s|$, with $p$ the pressure and $\Delta s$ the
/// slip of the counterface past the node in each increment.
///
/// Source: Archard 1953; for inserts Knight 2007 with $K_w$ = 2.64e-7 mm3/(N m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Archard {
    /// Wear factor Kw, mm3 of wear for each newton and metre of sliding.
    pub wear_factor_mm3_per_nm: f64,
}

impl Archard {
    /// The wear factor Kw, by default that of Knight 2007.
    pub const WEAR_FACTOR: Parameter = Parameter {
        name: "wear_factor_mm3_per_nm",
        about: "Volume worn for each newton of load and metre of sliding.",
        default: 2.64e-7,
        least: 0.0,
        most: 1e-3,
        source: "knight2007",
        known: Known::Read,
    };
}

impl WearLaw for Archard {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        NodeWear::of_depth(self.wear_factor_mm3_per_nm / MM_PER_M * cycle.pressure_slip_mpa_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_near, depth_mm};
    use super::*;

    #[test]
    fn verify_flat_pin_depth_is_kw_p_s() {
        let law = Archard {
            wear_factor_mm3_per_nm: 2.64e-7,
        };
        // 10 MPa over 10 mm is 0.1 N m on each square millimetre.
        let path = [(10.0, [3.0, 4.0]), (10.0, [-5.0, 0.0])];
        assert_near(depth_mm(&law, &path), 2.64e-7 * 0.1);
    }
}
