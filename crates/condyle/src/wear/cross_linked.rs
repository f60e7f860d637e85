//! Cross-linked polyethylene: the wear of conventional polyethylene by the same law, times a factor.

use std::sync::Arc;

use super::law::{NodeWear, WearLaw};
use super::{MeanCycle, NamedLaw};
use crate::parameter::{Known, Parameter};

/// The law of conventional polyethylene times a factor.
///
/// $\text{depth} = c \cdot \text{depth of conventional polyethylene}$, independent of pressure and cross-shear, since no
/// factors measured by both were found. Pins that slide along one line wear equally with and without cross-linking
/// (Kilgour and Elfick 2009), so on such paths this law underestimates the wear.
#[derive(Clone, Debug)]
pub struct CrossLinked {
    /// The law of conventional polyethylene.
    pub law: Arc<dyn WearLaw>,
    /// Its wear over that of conventional polyethylene, $c$.
    pub wear_over_conventional: f64,
}

impl CrossLinked {
    /// About 50 kGy: the upper bound of pins that wear less than half as much as conventional ones (Abdelgaied 2013).
    pub const MODERATE: Parameter = Parameter {
        name: "wear_over_conventional",
        about: "Wear relative to that of conventional polyethylene by the same law.",
        default: 0.5,
        least: 1e-3,
        most: 2.0,
        source: "abdelgaied2013",
        known: Known::Read,
    };
    /// About 100 kGy: the middle of 0.14 to 0.27, measured on inserts of two designs in simulators (Haider 2012).
    pub const HIGH: Parameter = Parameter {
        default: 0.2,
        source: "haider2012",
        ..Self::MODERATE
    };

    /// Applies the factor to a named law.
    pub fn under(law: NamedLaw, wear_over_conventional: f64) -> NamedLaw {
        let own = Self {
            law: law.law,
            wear_over_conventional,
        };
        NamedLaw {
            law: Arc::new(own),
            ..law
        }
    }
}

impl WearLaw for CrossLinked {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let conventional = self.law.wear(cycle);
        NodeWear {
            depth_mm: self.wear_over_conventional * conventional.depth_mm,
            ..conventional
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::WEAR_LAWS;
    use super::super::tests::{assert_near, depth_mm, outside, rectangle};
    use super::*;

    #[test]
    fn every_law_wears_so_many_times_as_much_and_has_its_range() {
        let path = [rectangle(12.0, [3.0, 1.0]), rectangle(4.0, [3.0, 1.0])].concat();
        for kind in WEAR_LAWS {
            let conventional = kind.with_defaults();
            let own = CrossLinked::under(conventional.clone(), 0.2);
            assert_eq!(own.word, conventional.word);
            let [own, conventional] = [&own.law, &conventional.law].map(AsRef::as_ref);
            assert_near(depth_mm(own, &path), 0.2 * depth_mm(conventional, &path));
            assert_eq!(outside(own, &path), outside(conventional, &path));
        }
    }
}
