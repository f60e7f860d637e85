//! The wear law: any of a list of kinds, each with the constants that it declares.

use std::borrow::Cow;

use condyle::parameter::{Known, Parameter};
use condyle::wear::{NamedLaw, WEAR_LAWS, WearLawKind};
use thiserror::Error;

use super::table::{Context, Table, WearLaws, WriteWaveform};
use crate::config::{
    Choices, Key, Limits, Log, Offered, Page, Section, Setting, TableSchema, WhereSilent, Writer,
    within,
};

/// A wear law and its constants.
#[derive(Clone, Debug)]
pub struct Wear {
    kind: &'static WearLawKind,
    /// One for each parameter of the kind, in their order.
    constants: Vec<f64>,
    /// What it was chosen from.
    offered: WearLaws,
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
        Self {
            kind,
            constants,
            offered: WEAR_LAWS,
        }
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

    /// Its constants, in the order of its parameters.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// The same law with constants by which it wears so many times as much, whatever the cycle.
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
    pub(super) fn law(&self) -> NamedLaw {
        NamedLaw {
            word: self.kind.word,
            law: self.kind.law(&self.constants),
        }
    }

    /// Whether the law of that word, with the constants of the case if it is the case's, is remembered rather
    /// than read.
    pub fn is_approximate(&self, word: &str) -> bool {
        if word != self.kind.word {
            let other = self.offered.iter().find(|other| other.word == word);
            return other.is_some_and(|other| other.is_approximate());
        }
        let mut constants = self.kind.parameters.iter().zip(&self.constants);
        let is_remembered = |(parameter, value): (&Parameter, &f64)| {
            parameter.known == Known::Approximate && *value == parameter.default
        };
        self.kind.known == Known::Approximate || constants.any(is_remembered)
    }

    /// Every other law that it was chosen from, with the defaults of its constants.
    pub(super) fn beside(&self) -> Vec<NamedLaw> {
        let others = self.offered.iter();
        let others = others.filter(|other| other.word != self.kind.word);
        others.map(|other| other.with_defaults()).collect()
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
        Some(Self {
            kind,
            constants,
            offered: laws,
        })
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
        doc: doc_of(parameter),
        kind: f64::kind(),
        silent: WhereSilent::Takes(format!("{:?}", parameter.default)),
        limits: Some(limits_of(parameter)),
    }
}

/// What a constant is; a default that nobody read says so.
fn doc_of(parameter: &Parameter) -> Cow<'static, str> {
    if parameter.known == Known::Approximate {
        return format!("{} The default is approximate.", parameter.about).into();
    }
    parameter.about.into()
}

fn limits_of(parameter: &Parameter) -> Limits {
    within(parameter.least, parameter.most)
}

impl Table for Wear {
    const NAME: &'static str = "wear";

    fn read_in(root: &Section<'_>, context: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read(&root.table(Self::NAME, log), context.wear_laws, log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, laws: WearLaws) -> TableSchema {
        case.with_table(
            Self::NAME,
            TableSchema::new("The wear law.").with_choices(&Self::choices(laws)),
        )
    }

    fn add_to_page(page: &mut Page, laws: WearLaws) {
        let choices = Self::choices(laws);
        page.chosen("`[wear]`", std::slice::from_ref(&choices.by), &choices);
        page.push("\n");
        laws.iter().for_each(|law| page.push(&law_line(law)));
    }
}

/// The formula of a law and where its constants are from.
fn law_line(law: &WearLawKind) -> String {
    let source = |parameter: &Parameter| match parameter.source {
        "choice" => "choice".to_owned(),
        key if parameter.known == Known::Approximate => format!("[{key}] (approximate)"),
        key => format!("[{key}]"),
    };
    let sources: Vec<String> = law.parameters.iter().map(source).collect();
    let (word, about, sources) = (law.word, law.about, sources.join(", "));
    let formula = if law.known == Known::Approximate {
        " The formula is approximate: remembered rather than read."
    } else {
        ""
    };
    let constants = if sources.is_empty() {
        String::new()
    } else {
        format!(" Its constants are from: {sources}.")
    };
    format!("- `{word}`: {about}{constants}{formula}\n")
}
