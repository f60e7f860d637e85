//! The interface of wear laws, and their description.

use std::fmt::Debug;
use std::sync::Arc;

use super::MeanCycle;
use crate::parameter::{Known, Parameter};

/// A law of wear. It sees the mean cycle of one node over all activities, and never a solver.
pub trait WearLaw: Debug + Send + Sync {
    /// Returns the wear of a node per cycle.
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear;
}

/// The wear of a node per cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeWear {
    /// Depth along the inward normal, mm; 0 or more, and 0 where nothing slides.
    pub depth_mm: f64,
    /// Part of the depth, 0 to 1, at pressures or cross-shear outside the range to which the law was fitted; none if
    /// its source gives no such range.
    pub part_outside: Option<f64>,
}

impl NodeWear {
    /// Creates the wear by a law whose range of validity is unknown.
    pub fn of_depth(depth_mm: f64) -> Self {
        Self {
            depth_mm,
            part_outside: None,
        }
    }
}

/// A kind of wear law: its name, its constants, and the constructor from their values.
///
/// Case files, pages and other interfaces read the laws from these descriptions.
#[derive(Clone, Copy, Debug)]
pub struct WearLawKind {
    /// Name in case files.
    pub word: &'static str,
    /// Formula, in one line.
    pub about: &'static str,
    /// Certainty of the formula.
    pub known: Known,
    /// Constants of the law.
    pub parameters: &'static [Parameter],
    /// Returns the constants with which the wear in every cycle is multiplied by a factor; calibrations use it.
    pub scaled: fn(&[f64], f64) -> Vec<f64>,
    /// Creates the law from the values of its constants, in their order.
    pub make: fn(&[f64]) -> Arc<dyn WearLaw>,
}

/// A law of wear with its name.
#[derive(Clone, Debug)]
pub struct NamedLaw {
    /// Name of its kind.
    pub word: &'static str,
    /// The law.
    pub law: Arc<dyn WearLaw>,
}

impl WearLawKind {
    /// Returns the default of every constant.
    pub fn defaults(&self) -> Vec<f64> {
        let default = |parameter: &Parameter| parameter.default;
        self.parameters.iter().map(default).collect()
    }

    /// Returns the law with these `constants`, in the order of its parameters.
    ///
    /// # Panics
    /// If their number differs from that of the parameters, or one is out of its range.
    pub fn law(&self, constants: &[f64]) -> Arc<dyn WearLaw> {
        assert_eq!(constants.len(), self.parameters.len(), "{}", self.word);
        for (parameter, &value) in self.parameters.iter().zip(constants) {
            assert!(parameter.allows(value), "{} {value}", parameter.name);
        }
        (self.make)(constants)
    }

    /// Returns the law with default constants.
    pub fn with_defaults(&self) -> NamedLaw {
        NamedLaw {
            word: self.word,
            law: self.law(&self.defaults()),
        }
    }

    /// Returns true if the formula or any default is quoted from memory.
    pub fn is_approximate(&self) -> bool {
        let mut known = self.parameters.iter().map(|parameter| parameter.known);
        self.known == Known::Approximate || known.any(|known| known == Known::Approximate)
    }
}

/// Multiplies the first `count` constants: [`WearLawKind::scaled`] of a law whose depth is proportional to these.
pub(super) fn first_times(count: usize, constants: &[f64], times: f64) -> Vec<f64> {
    let mut scaled = constants.to_vec();
    for constant in &mut scaled[..count] {
        *constant *= times;
    }
    scaled
}

/// Wear factor on a circular path, whose cross-shear is 0.5 by definition.
pub(super) const CIRCLE_FACTOR: Parameter = Parameter {
    name: "circle_factor_mm3_per_nm",
    about: "Wear factor on a circular path.",
    default: 1.63e-6,
    least: 0.0,
    most: 1e-3,
    source: "saikko2005",
    known: Known::Read,
};
/// Pressure of the tests behind [`CIRCLE_FACTOR`].
pub(super) const MEASURED_AT: Parameter = Parameter {
    name: "measured_at_mpa",
    about: "Pressure at which the factor was measured; wear at higher pressures is outside of the fit.",
    default: 1.1,
    least: 0.0,
    most: 1000.0,
    source: "saikko2005",
    known: Known::Approximate,
};

/// Declares the files of the wear laws, each with a `KIND`, and lists them.
macro_rules! wear_laws {
    ($($law:ident,)+) => {
        $( mod $law; )+

        /// The built-in wear laws; the first is the default.
        pub const WEAR_LAWS: &[&WearLawKind] = &[$( &$law::KIND, )+];
    };
}

pub(super) use wear_laws;
