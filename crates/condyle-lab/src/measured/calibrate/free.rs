//! Which constants of a law a calibration changes.

use condyle_io::case::{ConstantError, Wear};

use super::CalibrateError;
use super::fit::Start;

/// A law, and what of it may change.
pub(super) struct Free {
    /// With the constants that the search begins from.
    pub(super) law: Wear,
    what: What,
}

enum What {
    /// How much it wears, whatever the cycle.
    Level,
    /// These constants, by their places among all.
    Constants(Vec<usize>),
}

impl Free {
    /// The constants of these names, or how much the law wears if there are none.
    pub(super) fn new(law: Wear, names: &[String]) -> Result<Self, CalibrateError> {
        if names.is_empty() {
            let what = What::Level;
            return Ok(Self { law, what });
        }
        let places: Result<Vec<_>, _> = names.iter().map(|name| place(&law, name)).collect();
        let what = What::Constants(places?);
        Ok(Self { law, what })
    }

    /// Where the search begins: a parameter is a constant over what it is at first, or just how many times as much the
    /// law wears.
    pub(super) fn start(&self) -> Start {
        let What::Constants(places) = &self.what else {
            return Start {
                at: vec![1.0],
                limits: vec![[0.0, f64::INFINITY]],
                in_proportion: true,
            };
        };
        let parameters = self.law.kind().parameters;
        let limits = |&place: &usize| {
            [parameters[place].least, parameters[place].most].map(|end| end / self.unit(place))
        };
        Start {
            at: places
                .iter()
                .map(|&place| self.law.constants()[place] / self.unit(place))
                .collect(),
            limits: places.iter().map(limits).collect(),
            in_proportion: false,
        }
    }

    /// The law with these parameters.
    pub(super) fn law(&self, at: &[f64]) -> Result<Wear, ConstantError> {
        match &self.what {
            What::Level => self.law.scaled(at[0]),
            What::Constants(places) => {
                let names = places
                    .iter()
                    .map(|&place| self.law.kind().parameters[place].name);
                let values = places
                    .iter()
                    .zip(at)
                    .map(|(&place, value)| value * self.unit(place));
                let mut named = names.zip(values);
                named.try_fold(self.law.clone(), |law, (name, value)| {
                    law.with_constant(name, value)
                })
            }
        }
    }

    /// The constants at parameters that may lie beyond what the law can have, each where it ends at the latest.
    pub(super) fn constants_near(&self, at: &[f64]) -> Vec<f64> {
        let constants = match &self.what {
            What::Level => (self.law.kind().scaled)(self.law.constants(), at[0].max(0.0)),
            What::Constants(places) => {
                let mut constants = self.law.constants().to_vec();
                for (&place, value) in places.iter().zip(at) {
                    constants[place] = value * self.unit(place);
                }
                constants
            }
        };
        let limits = constants.iter().zip(self.law.kind().parameters);
        let inside = limits.map(|(value, parameter)| value.clamp(parameter.least, parameter.most));
        inside.collect()
    }

    /// Whether the constant of that place changes.
    pub(super) fn changes(&self, place: usize) -> bool {
        match &self.what {
            What::Level => {
                (self.law.kind().scaled)(self.law.constants(), 2.0)[place]
                    != self.law.constants()[place]
            }
            What::Constants(places) => places.contains(&place),
        }
    }

    /// The parameter that a constant goes by.
    pub(super) fn parameter_of(&self, place: usize) -> usize {
        match &self.what {
            What::Level => 0,
            What::Constants(places) => places.iter().position(|&own| own == place).unwrap_or(0),
        }
    }

    /// Whether it is how much the law wears that changes.
    pub(super) fn is_level(&self) -> bool {
        matches!(self.what, What::Level)
    }

    /// What a parameter of 1 is.
    fn unit(&self, place: usize) -> f64 {
        let size = self.law.constants()[place].abs();
        if size > 0.0 { size } else { 1.0 }
    }
}

fn place(law: &Wear, name: &str) -> Result<usize, CalibrateError> {
    let parameters = law.kind().parameters;
    let found = parameters
        .iter()
        .position(|parameter| parameter.name == name);
    found.ok_or_else(|| CalibrateError::UnknownConstant {
        law: law.kind().word,
        name: name.to_owned(),
        known: parameters
            .iter()
            .map(|parameter| format!("`{}`", parameter.name))
            .collect::<Vec<_>>()
            .join(", "),
    })
}

/// Constants of a law as a case gives them.
pub(super) fn in_words(law: &Wear) -> String {
    let parameters = law.kind().parameters.iter().zip(law.constants());
    let words: Vec<String> = parameters
        .map(|(parameter, value)| format!("{} = {value:.4e}", parameter.name))
        .collect();
    words.join(", ")
}
