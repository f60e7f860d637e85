//! What is wrong with a case, before anything is built of it.

use std::path::Path;

use condyle_case::case::Case;

use crate::failure::Failure;

/// Reads the case at `path`, and says everything that is wrong with it.
pub fn check(path: &Path) -> Result<(), Failure> {
    match Case::read(path) {
        Ok(_) => Ok(()),
        Err(problems) => Err(Failure::from(&problems)),
    }
}
