//! Problems of a case, before anything is built from it.

use std::path::Path;

use condyle_case::case::Case;

use crate::failure::Failure;

/// Reads the case at `path` and reports all of its problems.
pub fn check(path: &Path) -> Result<(), Failure> {
    match Case::read(path) {
        Ok(_) => Ok(()),
        Err(problems) => Err(Failure::from(&problems)),
    }
}
