//! Cross-linked polyethylene: it wears as conventional polyethylene does by the same law, times a factor.

use std::sync::Arc;

use super::law::{NodeWear, WearLaw};
use super::{MeanCycle, NamedLaw};
use crate::parameter::{Known, Parameter};

/// A law of conventional polyethylene under which another one wears.
///
/// $\text{depth} = c \cdot \text{depth of conventional polyethylene}$, whatever the pressure and the cross-shear: measured
/// factors by both were not to be had. Pins that slide along one line wear as much cross-linked as not
/// (Kilgour and Elfick 2009), so such paths wear more than this says.
#[derive(Clone, Debug)]
pub struct CrossLinked {
    /// The law of conventional polyethylene.
    pub law: Arc<dyn WearLaw>,
    /// Its wear over that of conventional polyethylene, $c$.
    pub wear_over_conventional: f64,
}

impl CrossLinked {
    /// After some 50 kGy: pins wear less than half as much as conventional ones (Abdelgaied 2013), of which this is the
    /// bound.
    pub const MODERATE: Parameter = Parameter {
        name: NAME,
        about: ABOUT,
        default: 0.5,
        least: 1e-3,
        most: 2.0,
        source: "abdelgaied2013",
        known: Known::Read,
    };
    /// After some 100 kGy: the middle of 0.14 to 0.27, which knees of two designs had in simulators (Haider 2012).
    pub const HIGH: Parameter = Parameter {
        name: NAME,
        about: ABOUT,
        default: 0.2,
        least: 1e-3,
        most: 2.0,
        source: "haider2012",
        known: Known::Read,
    };

    /// A named law with that polyethylene.
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

const NAME: &str = "wear_over_conventional";
const ABOUT: &str = "What it wears over what conventional polyethylene would wear by the same law.";

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
    use super::super::paths::{assert_near, depth_mm, outside, rectangle};
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
