//! What a wear law is, and how one is offered.

use std::fmt::Debug;
use std::sync::Arc;

use crate::contact::NodeHistory;
use crate::parameter::Parameter;

/// A law of wear. It sees what happened at one node through a whole cycle, and never a solver.
pub trait WearLaw: Debug + Send + Sync {
    /// Depth worn at a node by one cycle, mm, along the inward normal; 0 or more.
    fn depth_per_cycle_mm(&self, history: &NodeHistory<'_>) -> f64;
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
    /// Its constants.
    pub parameters: &'static [Parameter],
    /// The law with these values of its constants, in their order.
    pub make: fn(&[f64]) -> Arc<dyn WearLaw>,
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
