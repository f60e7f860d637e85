//! How much a study may list.

use std::ops::Range;

use super::reason::StudyReason;
use crate::config::Log;

/// Inputs of a study at most, and designs that it compares.
const MOST: usize = 256;

/// Reports more of something than anybody means: each costs a look at the case.
pub(super) fn check_count(
    what: &'static str,
    count: usize,
    span: Range<usize>,
    log: &mut Log<'_>,
) -> Option<()> {
    if count <= MOST {
        return Some(());
    }
    let most = MOST;
    log.problem(span, StudyReason::TooMany { what, count, most });
    None
}
