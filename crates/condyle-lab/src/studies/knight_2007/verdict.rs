//! Whether ours lies where the paper's does.

use std::fmt;

use serde::Serialize;

/// Whether ours lies where the paper's does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It does.
    Agrees,
    /// It does not.
    Differs,
    /// What would be compared is not the same, or not there.
    CannotBeJudged,
}

impl Verdict {
    /// The verdict of a rule.
    pub(super) fn of(agrees: bool) -> Self {
        if agrees { Self::Agrees } else { Self::Differs }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Agrees => "yes",
            Self::Differs => "no",
            Self::CannotBeJudged => "cannot be judged",
        })
    }
}
