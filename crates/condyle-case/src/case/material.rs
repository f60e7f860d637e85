//! Polyethylene of the insert: elasticity, cross-linking, creep.

use condyle::creep::LeePienkowski;
use condyle::parameter::Parameter;
use condyle::wear::{CrossLinked, NamedLaw};
use condyle_fem::Elastic;

use crate::config::*;

settings! {
    /// Polyethylene of the insert.
    Material {
        /// Young's modulus.
        youngs_modulus_mpa: f64 = 463.0, in within(1.0, 100_000.0);
        /// Poisson's ratio.
        poissons_ratio: f64 = 0.46, in within(0.0, 0.499);
        /// Density.
        density_mg_per_mm3: f64 = 0.93, in within(0.5, 9.0);
        /// Degree of cross-linking.
        [flat] cross_linking: CrossLinking;
    }
}

impl Material {
    pub(crate) fn elastic(&self) -> Elastic {
        Elastic {
            youngs_modulus: self.youngs_modulus_mpa,
            poissons_ratio: self.poissons_ratio,
        }
    }
}

const MODERATE: Parameter = CrossLinked::MODERATE;
const HIGH: Parameter = CrossLinked::HIGH;

settings! {
    /// Moderately cross-linked polyethylene.
    ModeratelyCrossLinked {
        /// Wear relative to that of conventional polyethylene by the same law; by default the upper bound of Abdelgaied 2013, measured on pins.
        wear_over_conventional: f64 = MODERATE.default, in limits_of(&MODERATE);
    }

    /// Highly cross-linked polyethylene.
    HighlyCrossLinked {
        /// Wear relative to that of conventional polyethylene by the same law; by default the middle of 0.14 to 0.27, measured on knees by Haider 2012.
        wear_over_conventional: f64 = HIGH.default, in limits_of(&HIGH);
    }
}

variants! {
    /// Degree of cross-linking of the polyethylene.
    CrossLinking by
    /// Degree of cross-linking: the wear by every law is multiplied by a factor. Elasticity and creep are unchanged.
    cross_linking = "none" {
        /// Conventional polyethylene: laws as they were fitted.
        None = "none",
        /// After about 50 kGy.
        Moderate(ModeratelyCrossLinked) = "moderate",
        /// After about 100 kGy.
        High(HighlyCrossLinked) = "high",
    }
}

impl CrossLinking {
    /// Wear relative to that of conventional polyethylene; `None` for conventional polyethylene itself.
    pub fn wear_over_conventional(&self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Moderate(moderate) => Some(moderate.wear_over_conventional),
            Self::High(high) => Some(high.wear_over_conventional),
        }
    }

    /// Returns a law of wear for this polyethylene.
    pub fn under(&self, law: NamedLaw) -> NamedLaw {
        match self.wear_over_conventional() {
            Some(times) => CrossLinked::under(law, times),
            None => law,
        }
    }
}

const A: Parameter = LeePienkowski::STRAIN_AT_10000_MIN;
const B: Parameter = LeePienkowski::STRAIN_PER_DECADE;
const R: Parameter = LeePienkowski::RECOVERING;

settings_of! {
    LeePienkowski {
        /// Strain by creep after 10,000 min under 1 MPa. The default is approximate.
        strain_at_10000_min_per_mpa: f64 = A.default, in limits_of(&A);
        /// Strain by creep per decade of time under 1 MPa. The default is approximate.
        strain_per_decade_per_mpa: f64 = B.default, in limits_of(&B);
        /// Part of the creep that recovers after unloading; a scan of an unloaded insert shows the rest.
        recovering_fraction: f64 = R.default, in limits_of(&R);
    }
}

variants! {
    /// Creep of the polyethylene of the insert.
    Creep by
    /// Law of creep.
    law = "none" {
        /// It does not.
        None = "none",
        /// By the logarithm of time, as Lee and Pienkowski measured it.
        LeePienkowski(LeePienkowski) = "lee-pienkowski",
    }
}

impl Creep {
    pub(super) fn law(&self) -> Option<LeePienkowski> {
        match self {
            Self::None => None,
            Self::LeePienkowski(constants) => Some(*constants),
        }
    }
}
