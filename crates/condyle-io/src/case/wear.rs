//! The wear law: any of a list of kinds, each with the constants that it declares.

use std::sync::Arc;

use condyle::parameter::Parameter;
use condyle::wear::{WearLaw, WearLawKind};
use thiserror::Error;

use crate::keyed::{
    Choices, Key, Limits, Log, Offered, Section, Setting, WhereSilent, Writer, within,
};

/// Kinds of wear law to choose from; the first is taken where a case names none.
pub type WearLaws = &'static [&'static WearLawKind];

/// A wear law and its constants.
#[derive(Clone, Debug)]
pub struct Wear {
    kind: &'static WearLawKind,
    /// One for each parameter of the kind, in their order.
    constants: Vec<f64>,
}

/// Why a wear law cannot have a constant.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ConstantError {
    /// The law has none of that name.
    #[error("the wear law \"{law}\" has no `{name}`; take a case with a law that has")]
    Unknown {
        /// Word of the law.
        law: &'static str,
        /// The constant asked for.
        name: &'static str,
    },
    /// A value outside its range.
    #[error("`{name}` cannot be {value:e}: it can be {limits}")]
    OutOfRange {
        /// The constant.
        name: &'static str,
        /// The value.
        value: f64,
        /// What it can be.
        limits: Limits,
    },
}

impl PartialEq for Wear {
    fn eq(&self, other: &Self) -> bool {
        self.kind.word == other.kind.word && self.constants == other.constants
    }
}

impl Wear {
    /// A law with the defaults of its constants.
    pub fn new(kind: &'static WearLawKind) -> Self {
        let constants = kind.defaults();
        Self { kind, constants }
    }

    /// Which law.
    pub fn kind(&self) -> &'static WearLawKind {
        self.kind
    }

    /// The constant of that name.
    ///
    /// # Errors
    /// A name that the law has no constant of.
    pub fn constant(&self, name: &'static str) -> Result<f64, ConstantError> {
        Ok(self.constants[self.index(name)?])
    }

    /// The same law with another value of the constant of that name.
    ///
    /// # Errors
    /// A name that the law has no constant of, or a value outside its range.
    pub fn with_constant(mut self, name: &'static str, value: f64) -> Result<Self, ConstantError> {
        let index = self.index(name)?;
        let parameter = &self.kind.parameters[index];
        if !parameter.allows(value) {
            let limits = limits_of(parameter);
            return Err(ConstantError::OutOfRange {
                name,
                value,
                limits,
            });
        }
        self.constants[index] = value;
        Ok(self)
    }

    fn index(&self, name: &'static str) -> Result<usize, ConstantError> {
        let mut parameters = self.kind.parameters.iter();
        let found = parameters.position(|parameter| parameter.name == name);
        let law = self.kind.word;
        found.ok_or(ConstantError::Unknown { law, name })
    }

    /// The law itself.
    pub(super) fn law(&self) -> Arc<dyn WearLaw> {
        self.kind.law(&self.constants)
    }

    /// The key that chooses the law, and the keys that each brings.
    pub(super) fn choices(laws: &[&WearLawKind]) -> Choices {
        let offered = |law: &&WearLawKind| Offered {
            word: law.word,
            keys: law.parameters.iter().map(key_of).collect(),
        };
        let default = laws.first().map_or("", |law| law.word);
        let offered = laws.iter().map(offered).collect();
        Choices::new("law", "Which law.", default, offered)
    }

    /// Reads `[wear]`, whose law is one of `laws`.
    pub(super) fn read(section: &Section<'_>, laws: WearLaws, log: &mut Log<'_>) -> Option<Self> {
        let word = Self::choices(laws).read(section, &[], log)?;
        let kind = laws.iter().find(|law| law.word == word)?;
        let read = |parameter: &Parameter| {
            section.setting(&key_of(parameter), Some(parameter.default), log)
        };
        let constants: Vec<Option<f64>> = kind.parameters.iter().map(read).collect();
        let constants = constants.into_iter().collect::<Option<_>>()?;
        Some(Self { kind, constants })
    }

    /// Writes the law and its constants.
    pub(super) fn write(&self, out: &mut Writer) {
        out.word(&Self::choices(&[self.kind]).by, self.kind.word);
        for (parameter, value) in self.kind.parameters.iter().zip(&self.constants) {
            out.setting(&key_of(parameter), value);
        }
    }
}

/// The key that gives a constant.
fn key_of(parameter: &Parameter) -> Key {
    Key {
        name: parameter.name,
        doc: parameter.about,
        kind: f64::kind(),
        silent: WhereSilent::Takes(format!("{:?}", parameter.default)),
        limits: Some(limits_of(parameter)),
    }
}

fn limits_of(parameter: &Parameter) -> Limits {
    within(parameter.least, parameter.most)
}
