//! The wear law: any of a list of kinds, each with the constants that it declares.

use condyle::parameter::{Known, Parameter};
use condyle::wear::{NamedLaw, WEAR_LAWS, WearLawKind};
use thiserror::Error;

use crate::config::*;

/// Kinds of wear law to choose from; the first is the default.
pub type WearLaws = &'static [&'static WearLawKind];

/// A wear law and its constants.
#[derive(Clone, Debug)]
pub struct Wear {
    kind: &'static WearLawKind,
    /// In the order of the kind's parameters.
    constants: Vec<f64>,
    offered: WearLaws,
}

/// A constant that a wear law cannot have.
#[expect(missing_docs, reason = "the messages describe the variants and fields")]
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ConstantError {
    #[error("the wear law \"{law}\" has no `{name}`; use a case whose law has it")]
    Unknown {
        law: &'static str,
        name: &'static str,
    },
    #[error("`{name}` is {value:e}; it must be {limits}")]
    OutOfRange {
        name: &'static str,
        value: f64,
        limits: Limits,
    },
}

impl PartialEq for Wear {
    fn eq(&self, other: &Self) -> bool {
        self.kind.word == other.kind.word && self.constants == other.constants
    }
}

impl Wear {
    /// Returns a law with the defaults of its constants.
    pub fn new(kind: &'static WearLawKind) -> Self {
        let constants = kind.defaults();
        Self {
            kind,
            constants,
            offered: WEAR_LAWS,
        }
    }

    /// Returns the kind of law.
    pub fn kind(&self) -> &'static WearLawKind {
        self.kind
    }

    /// Returns the constant of that name.
    ///
    /// # Errors
    /// The law has no such constant.
    pub fn constant(&self, name: &'static str) -> Result<f64, ConstantError> {
        Ok(self.constants[self.index(name)?])
    }

    /// Its constants, in the order of its parameters.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// Returns the law with constants scaled so that every cycle wears `times` as much.
    ///
    /// # Errors
    /// A constant outside its range.
    pub fn scaled(&self, times: f64) -> Result<Self, ConstantError> {
        let scaled = (self.kind.scaled)(&self.constants, times);
        let mut named = self.kind.parameters.iter().zip(scaled);
        named.try_fold(self.clone(), |law, (parameter, value)| {
            law.with_constant(parameter.name, value)
        })
    }

    /// Returns the law with another value of the constant of that name.
    ///
    /// # Errors
    /// The law has no such constant, or the value is outside its range.
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

    pub(super) fn law(&self) -> NamedLaw {
        NamedLaw {
            word: self.kind.word,
            law: self.kind.law(&self.constants),
        }
    }

    /// Returns true if the law with that word is quoted from memory; the law of the case is judged with the constants
    /// of the case.
    pub fn is_approximate(&self, word: &str) -> bool {
        if word != self.kind.word {
            let other = self.offered.iter().find(|other| other.word == word);
            return other.is_some_and(|other| other.is_approximate());
        }
        let mut constants = self.kind.parameters.iter().zip(&self.constants);
        let is_from_memory = |(parameter, value): (&Parameter, &f64)| {
            parameter.known == Known::Approximate && *value == parameter.default
        };
        self.kind.known == Known::Approximate || constants.any(is_from_memory)
    }

    /// Returns every other available law, with the defaults of its constants.
    pub(super) fn comparison_laws(&self) -> Vec<NamedLaw> {
        let others = self.offered.iter();
        let others = others.filter(|other| other.word != self.kind.word);
        others.map(|other| other.with_defaults()).collect()
    }

    fn choices(laws: &[&WearLawKind]) -> Choices {
        let offered = |law: &&WearLawKind| Offered {
            word: law.word,
            items: law
                .parameters
                .iter()
                .map(|parameter| Item::Key(key_of(parameter)))
                .collect(),
        };
        let default = laws.first().map_or("", |law| law.word);
        let offered = laws.iter().map(offered).collect();
        Choices::new("law", "Wear law.", default, offered)
    }

    /// Describes the table of a case that may choose from `laws`.
    pub(super) fn item_of(laws: WearLaws) -> Item {
        let items = vec![Item::Choice(Self::choices(laws))];
        Item::Table(TableItem::new(Self::TABLE, "The wear law.", items))
    }

    /// Name of the table.
    pub(super) const TABLE: &'static str = "wear";
}

impl Settings for Wear {
    fn items() -> Vec<Item> {
        vec![Item::Choice(Self::choices(WEAR_LAWS))]
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let offered = log.wear_laws;
        let word = Self::choices(offered).read(section, log)?;
        let kind = offered.iter().find(|law| law.word == word)?;
        let read = |parameter: &Parameter| {
            section.setting(&key_of(parameter), Some(parameter.default), log)
        };
        let constants: Vec<Option<f64>> = kind.parameters.iter().map(read).collect();
        Some(Self {
            kind,
            constants: constants.into_iter().collect::<Option<_>>()?,
            offered,
        })
    }

    fn write(&self, out: &mut Writer) {
        let by = Self::choices(&[self.kind]).by;
        out.line(&format!("{} = {:?}", by.name, self.kind.word), &by.doc);
        for (parameter, value) in self.kind.parameters.iter().zip(&self.constants) {
            value.write(&key_of(parameter), out);
        }
    }
}

fn key_of(parameter: &Parameter) -> Key {
    let approximate = match parameter.known {
        Known::Approximate => " The default is approximate.",
        Known::Read | Known::Chosen => "",
    };
    let doc = format!("{}{approximate}", parameter.about);
    Key::number(parameter.name, doc, parameter.default, limits_of(parameter))
}
