//! The file that a case comes from.

use std::sync::Arc;

use super::assignment::LeftOutConstant;
use crate::config::Source;

/// The text of a case file, and what of it was left out.
///
/// All origins are equal: two cases are the same if they say the same, wherever they stand.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    /// The text.
    pub(super) source: Source,
    /// Constants that a law chosen from outside does not have.
    pub(super) left_out: Vec<LeftOutConstant>,
}

impl Origin {
    pub(super) fn of(source: &Source) -> Self {
        Self {
            source: Arc::clone(source),
            left_out: Vec::new(),
        }
    }
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
