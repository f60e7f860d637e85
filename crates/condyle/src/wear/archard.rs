//! Archard's law.

use std::sync::Arc;

use super::law::{WearLaw, WearLawKind};
use crate::contact::NodeHistory;
use crate::parameter::Parameter;

/// Archard's law as it is offered.
pub(super) const KIND: WearLawKind = WearLawKind {
    word: "archard",
    about: "Depth per cycle = Kw sum of p |ds|.",
    parameters: &[Archard::WEAR_FACTOR],
    make: |constants| {
        Arc::new(Archard {
            wear_factor_mm3_per_nm: constants[0],
        })
    },
};

/// Archard's law: $\text{depth per cycle} = K_w \sum p |\Delta s|$, with $p$ the pressure and $\Delta s$ the
/// slip of the femur past the node in each increment.
///
/// Source: Archard 1953; for knees Knight 2007 with $K_w$ = 2.64e-7 mm3/(N m).
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
    };
}

/// A metre in millimetres.
const MM_PER_M: f64 = 1000.0;

impl WearLaw for Archard {
    fn depth_per_cycle_mm(&self, history: &NodeHistory<'_>) -> f64 {
        self.wear_factor_mm3_per_nm / MM_PER_M * history.pressure_slip_mpa_mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{CycleHistory, Moment, Record};

    #[test]
    fn verify_flat_pin_depth_is_kw_p_s() {
        let law = Archard {
            wear_factor_mm3_per_nm: 2.64e-7,
        };
        let record = |slip_mm| Record {
            node: 0,
            pressed_mm2: 1.0,
            moment: Moment {
                pressure_mpa: 10.0,
                slip_mm,
            },
        };
        let mut history = CycleHistory::default();
        let slips = [[3.0, 4.0], [-5.0, 0.0]];
        let instants = slips.map(|slip_mm| history.record([record(slip_mm)].into_iter()));
        history.sort(1, &instants);
        // 10 MPa over 10 mm is 0.1 N m on each square millimetre.
        let depth = law.depth_per_cycle_mm(&history.node(0));
        assert!((depth - 2.64e-7 * 0.1).abs() < 1e-20);
    }
}
