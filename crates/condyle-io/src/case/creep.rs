//! How the polyethylene of the insert creeps.

use condyle::creep::LeePienkowski;
use condyle::parameter::Parameter;

use crate::config::{Limits, settings, variants, within};

const A: Parameter = LeePienkowski::STRAIN_AT_10000_MIN;
const B: Parameter = LeePienkowski::STRAIN_PER_DECADE;
const R: Parameter = LeePienkowski::RECOVERING;

const fn limits_of(parameter: &Parameter) -> Limits {
    within(parameter.least, parameter.most)
}

settings! {
    /// The constants of creep by the logarithm of time.
    LogarithmicCreep {
        /// Strain by creep after 10,000 min under 1 MPa. The default is approximate.
        strain_at_10000_min_per_mpa: f64 = A.default, in limits_of(&A);
        /// Strain by creep that each tenfold of time adds under 1 MPa. The default is approximate.
        strain_per_decade_per_mpa: f64 = B.default, in limits_of(&B);
        /// Part of the creep that recovers once the load is gone; what is left is what a scan of an unloaded insert sees.
        recovering_fraction: f64 = R.default, in limits_of(&R);
    }
}

variants! {
    /// How the polyethylene of the insert creeps.
    Creep by
    /// Which law of creep.
    law = "none" {
        /// It does not.
        None = "none",
        /// By the logarithm of time, as Lee and Pienkowski measured it.
        LeePienkowski(LogarithmicCreep) = "lee-pienkowski",
    }
}

impl Creep {
    /// The law itself, if the insert creeps.
    pub(super) fn law(&self) -> Option<LeePienkowski> {
        match self {
            Self::None => None,
            Self::LeePienkowski(constants) => Some(LeePienkowski {
                strain_at_10000_min_per_mpa: constants.strain_at_10000_min_per_mpa,
                strain_per_decade_per_mpa: constants.strain_per_decade_per_mpa,
                recovering_fraction: constants.recovering_fraction,
            }),
        }
    }
}
