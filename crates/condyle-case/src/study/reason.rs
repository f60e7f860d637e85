//! What only a study can have wrong.

use thiserror::Error;

use crate::config::{Level, Reason};

/// Why a study cannot be done.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StudyReason {
    /// Nothing varies.
    #[error("the study varies nothing")]
    NothingVaries,
    /// More inputs or designs than anybody means.
    #[error("the study has {count} {what}, and {most} are the most")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A value that the case does not take.
    #[error("the case does not take `{key} = {}`: {why}", text(value))]
    Refused {
        /// The key.
        key: String,
        /// The value.
        value: Level,
        /// What is said of it.
        why: String,
        /// What to do, where the case says so.
        advice: Option<String>,
    },
    /// A design that the case does not take.
    #[error("the case does not take the design `{name}`: {why}")]
    AlternativeRefused {
        /// Its name.
        name: String,
        /// What is said of it.
        why: String,
        /// What to do, where the case says so.
        advice: Option<String>,
    },
    /// A change of a design that is none.
    #[error("{why}")]
    NotSet {
        /// What is said of it.
        why: String,
    },
    /// A key that varies twice.
    #[error("`{key}` varies twice")]
    Twice {
        /// The key.
        key: String,
    },
    /// No value in the middle.
    #[error("the case has no number at `{key}` to go out from")]
    NoMiddle {
        /// The key.
        key: String,
    },
    /// A range that is empty.
    #[error("the range from {low} to {high} is empty")]
    EmptyRange {
        /// As written.
        low: f64,
        /// As written.
        high: f64,
    },
    /// A likeliest value that cannot occur.
    #[error("the likeliest value {mode} is not between {low} and {high}")]
    ModeOutside {
        /// The likeliest value.
        mode: f64,
        /// Least.
        low: f64,
        /// Most.
        high: f64,
    },
    /// A correlation of other than two keys.
    #[error("a correlation is between two keys")]
    NotTwoKeys,
    /// A correlation of what does not vary.
    #[error("`{key}` is no input with a distribution")]
    NotVaried {
        /// The key.
        key: String,
    },
    /// A design whose inputs know nothing of each other.
    #[error("inputs of a {design} design cannot be correlated")]
    CannotCorrelate {
        /// Its word.
        design: &'static str,
    },
    /// A design that is not for comparing others.
    #[error("designs cannot be compared by a {design} design")]
    CannotRank {
        /// Its word.
        design: &'static str,
    },
    /// A search over something else than a range.
    #[error("a search needs a range, and `{key}` has none")]
    NoRange {
        /// The key.
        key: String,
    },
    /// Levels that cannot be halved.
    #[error("a Morris design has an even number of levels, not {levels}")]
    OddLevels {
        /// As written.
        levels: u64,
    },
    /// Rows, and inputs beside them.
    #[error("a study of given rows has its inputs in the file")]
    RowsAndVary,
    /// A file without rows.
    #[error("the file has no rows")]
    NoRows,
    /// A row with too few or too many cells.
    #[error("this row has {found} cells where the first line has {wanted}, or an empty one")]
    WrongShape {
        /// Cells it has.
        found: usize,
        /// Cells it needs.
        wanted: usize,
    },
    /// An output that a run does not have.
    #[error("a run has no output `{name}`")]
    UnknownOutput {
        /// As written.
        name: String,
        /// One that looks like it.
        near: Option<String>,
        /// Every one.
        outputs: String,
    },
    /// No output at all.
    #[error("the study asks for no output")]
    NoOutput,
    /// A limit that limits nothing.
    #[error("a limit needs `least`, `most` or both")]
    NoBound,
}

fn text(level: &Level) -> String {
    match level {
        Level::Number(number) => number.to_string(),
        Level::Word(word) => format!("{word:?}"),
    }
}

impl Reason for StudyReason {
    fn advice(&self) -> Option<String> {
        let advice = match self {
            Self::Refused { advice, .. } => {
                return Some(advice.clone().unwrap_or_else(|| OTHER_VALUES.to_owned()));
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

const OTHER_VALUES: &str = "choose values that the case takes; a normal distribution is tried at four standard deviations, and \
    a truncated-normal one ends where you say";
