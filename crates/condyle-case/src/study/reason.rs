//! Problems that only a study can have.

use thiserror::Error;

use crate::config::{Level, Reason};

/// A problem of a study, at its place in the file.
#[derive(Clone, Debug, PartialEq, Error)]
pub(super) enum StudyReason {
    #[error("the study varies nothing")]
    NothingVaries,
    #[error("the study has {count} {what}, and {most} are the most")]
    TooMany {
        what: &'static str,
        count: usize,
        most: usize,
    },
    #[error("the case does not take `{key} = {}`: {why}", match value {
        Level::Number(number) => number.to_string(),
        Level::Word(word) => format!("{word:?}"),
    })]
    Refused {
        key: String,
        value: Level,
        why: String,
        advice: Option<String>,
    },
    #[error("the case does not take the design `{name}`: {why}")]
    AlternativeRefused {
        name: String,
        why: String,
        advice: Option<String>,
    },
    #[error("{why}")]
    NotSet { why: String },
    #[error("`{key}` varies twice")]
    Twice { key: String },
    #[error("the case has no number at `{key}` to go out from")]
    NoMiddle { key: String },
    #[error("the range from {low} to {high} is empty")]
    EmptyRange { low: f64, high: f64 },
    #[error("the likeliest value {mode} is not between {low} and {high}")]
    ModeOutside { mode: f64, low: f64, high: f64 },
    #[error("a correlation is between two keys")]
    NotTwoKeys,
    #[error("`{key}` is no input with a distribution")]
    NotVaried { key: String },
    #[error("inputs of a {design} design cannot be correlated")]
    CannotCorrelate { design: &'static str },
    #[error("designs cannot be compared by a {design} design")]
    CannotRank { design: &'static str },
    #[error("a search needs a range, and `{key}` has none")]
    NoRange { key: String },
    #[error("a Morris design has an even number of levels, not {levels}")]
    OddLevels { levels: u64 },
    #[error("a study of given rows has its inputs in the file")]
    RowsAndVary,
    #[error("the file has no rows")]
    NoRows,
    #[error("this row has {found} cells where the first line has {wanted}, or an empty one")]
    WrongShape { found: usize, wanted: usize },
    #[error("a run has no output `{name}`")]
    UnknownOutput {
        name: String,
        near: Option<String>,
        outputs: String,
    },
    #[error("the study asks for no output")]
    NoOutput,
    #[error("a limit needs `least`, `most` or both")]
    NoBound,
}

impl Reason for StudyReason {
    fn advice(&self) -> Option<String> {
        let advice = match self {
            Self::Refused { advice, .. } => {
                let other = "choose values that the case takes; a normal distribution is tried at four standard deviations, \
                             and a truncated-normal one ends where you say";
                return Some(advice.clone().unwrap_or_else(|| other.to_owned()));
            }
            Self::AlternativeRefused { advice, .. } => return advice.clone(),
            Self::NothingVaries => {
                "add `[[vary]]` with `key = \"contact.friction\"`, `low` and `high`"
            }
            Self::TooMany { .. } => "divide it into several studies",
            Self::NotSet { .. } => "write each as `\"insert.thickness_mm=8\"`",
            Self::Twice { .. } => "keep one of the two, or give both values as columns of rows",
            Self::NoMiddle { .. } => "give `mean` or `mode`, or write the key in the case",
            Self::EmptyRange { .. } => "write the smaller one as `low`",
            Self::ModeOutside { .. } => "give `mode` between `low` and `high`",
            Self::NotTwoKeys => {
                "write `keys = [\"contact.friction\", \"wear.wear_factor_mm3_per_nm\"]`"
            }
            Self::NotVaried { .. } => {
                "give it a `[[vary]]` with a distribution, or leave the correlation out"
            }
            Self::CannotCorrelate { .. } => {
                "use `kind = \"latin-hypercube\"` or `\"sobol\"`, or leave the correlation out"
            }
            Self::CannotRank { .. } => {
                "use `kind = \"latin-hypercube\"`, or leave the alternatives out"
            }
            Self::NoRange { .. } => "give `low` and `high` of a number that does not count",
            Self::OddLevels { .. } => "use 4, 6 or 8",
            Self::RowsAndVary => "remove `[[vary]]`, or choose another kind of design",
            Self::NoRows => {
                "write keys of the case in its first line, such as `contact.friction,insert.thickness_mm`, and values below"
            }
            Self::WrongShape { .. } => "give every row one value a column",
            Self::UnknownOutput { near, outputs, .. } => {
                return Some(match near {
                    Some(near) => format!("did you mean `{near}`? It can be {outputs}"),
                    None => format!("it can be {outputs}"),
                });
            }
            Self::NoOutput => "name one, such as `mass_loss_mg`, or leave the key out",
            Self::NoBound => "add `most = 40.0`",
        };
        Some(advice.to_owned())
    }
}
