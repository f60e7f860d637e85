//! Whether the polyethylene of the insert was cross-linked, and how much less it wears for that.

use condyle::parameter::Parameter;
use condyle::wear::{CrossLinked, NamedLaw};

use crate::config::{Limits, settings, variants, within};

const MODERATE: Parameter = CrossLinked::MODERATE;
const HIGH: Parameter = CrossLinked::HIGH;

const fn limits_of(parameter: &Parameter) -> Limits {
    within(parameter.least, parameter.most)
}

settings! {
    /// Moderately cross-linked polyethylene.
    ModeratelyCrossLinked {
        /// What it wears over what conventional polyethylene would wear by the same law; by default the bound of Abdelgaied 2013, whose pins wore less.
        wear_over_conventional: f64 = MODERATE.default, in limits_of(&MODERATE);
    }

    /// Highly cross-linked polyethylene.
    HighlyCrossLinked {
        /// What it wears over what conventional polyethylene would wear by the same law; by default the middle of 0.14 to 0.27, measured on knees by Haider 2012.
        wear_over_conventional: f64 = HIGH.default, in limits_of(&HIGH);
    }
}

variants! {
    /// Whether the polyethylene was cross-linked.
    CrossLinking by
    /// Whether the polyethylene was cross-linked: every law of wear, fitted to conventional polyethylene, is then multiplied by a factor. Elasticity and creep stay as given.
    cross_linking = "none" {
        /// Conventional polyethylene: laws as they were fitted.
        None = "none",
        /// After some 50 kGy.
        Moderate(ModeratelyCrossLinked) = "moderate",
        /// After some 100 kGy.
        High(HighlyCrossLinked) = "high",
    }
}

impl CrossLinking {
    /// What it wears over what conventional polyethylene would wear; none of conventional polyethylene itself.
    pub fn wear_over_conventional(&self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Moderate(moderate) => Some(moderate.wear_over_conventional),
            Self::High(high) => Some(high.wear_over_conventional),
        }
    }

    /// A law of wear with this polyethylene.
    pub fn under(&self, law: NamedLaw) -> NamedLaw {
        match self.wear_over_conventional() {
            Some(times) => CrossLinked::under(law, times),
            None => law,
        }
    }
}
