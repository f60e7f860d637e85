//! What a wear law is, and how one is offered.

use std::fmt::Debug;
use std::sync::Arc;

use super::MeanCycle;
use crate::parameter::{Known, Parameter};

/// A law of wear. It sees what one node goes through in the mean cycle of all activities, and never a solver.
pub trait WearLaw: Debug + Send + Sync {
    /// What one cycle wears at a node.
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear;
}

/// What one cycle wears at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeWear {
    /// Depth along the inward normal, mm; 0 or more, and 0 where nothing slides.
    pub depth_mm: f64,
    /// What part of it, 0 to 1, is worn outside of the pressures and cross-shear that the law was fitted to;
    /// none where its source names none.
    pub part_outside: Option<f64>,
}

impl NodeWear {
    /// That of a law of which it is not known what it was fitted to.
    pub fn of_depth(depth_mm: f64) -> Self {
        Self {
            depth_mm,
            part_outside: None,
        }
    }
}

/// A kind of wear law: its name, its constants, and how a law is made of their values.
///
/// Whatever offers wear laws, such as a case file, knows no more of one than this.
#[derive(Clone, Copy, Debug)]
pub struct WearLawKind {
    /// The word for it.
    pub word: &'static str,
    /// Its formula, in one line.
    pub about: &'static str,
    /// How well the formula is known.
    pub known: Known,
    /// Its constants.
    pub parameters: &'static [Parameter],
    /// The constants of a law that wears so many times as much, whatever the cycle: what a calibration changes first.
    pub scaled: fn(&[f64], f64) -> Vec<f64>,
    /// The law with these values of its constants, in their order.
    pub make: fn(&[f64]) -> Arc<dyn WearLaw>,
}

/// A law of wear with the word for it.
#[derive(Clone, Debug)]
pub struct NamedLaw {
    /// The word of its kind.
    pub word: &'static str,
    /// The law.
    pub law: Arc<dyn WearLaw>,
}

impl WearLawKind {
    /// The default of every constant.
    pub fn defaults(&self) -> Vec<f64> {
        let default = |parameter: &Parameter| parameter.default;
        self.parameters.iter().map(default).collect()
    }

    /// The law with these `constants`, in the order of its parameters.
    ///
    /// # Panics
    /// Unless there is one for each parameter, in its range.
    pub fn law(&self, constants: &[f64]) -> Arc<dyn WearLaw> {
        assert_eq!(constants.len(), self.parameters.len(), "{}", self.word);
        for (parameter, &value) in self.parameters.iter().zip(constants) {
            assert!(parameter.allows(value), "{} {value}", parameter.name);
        }
        (self.make)(constants)
    }

    /// The law with the defaults of its constants.
    pub fn with_defaults(&self) -> NamedLaw {
        NamedLaw {
            word: self.word,
            law: self.law(&self.defaults()),
        }
    }

    /// Whether its formula or any of its defaults is remembered rather than read.
    pub fn is_approximate(&self) -> bool {
        let mut known = self.parameters.iter().map(|parameter| parameter.known);
        self.known == Known::Approximate || known.any(|known| known == Known::Approximate)
    }
}

/// The constants with the first `count` of them `times` as large: [`WearLawKind::scaled`] of a law whose depth is in
/// proportion to these.
pub(super) fn first_times(count: usize, constants: &[f64], times: f64) -> Vec<f64> {
    let mut scaled = constants.to_vec();
    for constant in &mut scaled[..count] {
        *constant *= times;
    }
    scaled
}

/// Declares the files of the wear laws, each with a `KIND`, and lists them.
macro_rules! wear_laws {
    ($($law:ident,)+) => {
        $( mod $law; )+

        /// Every wear law that comes with condyle; the first is taken where none is named.
        pub const WEAR_LAWS: &[&WearLawKind] = &[$( &$law::KIND, )+];
    };
}

pub(super) use wear_laws;
