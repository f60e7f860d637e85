//! From a case to a march that is ready to go.

use std::path::Path;

use condyle::evolve::{March, WearTest};
use condyle_io::{
    cache::Cache,
    case::{BuildWarning, Built, Case},
};

use super::error::RunError;

/// Checks the case at `case_path` as far as a run would go before its first cycle: the file, the
/// meshes, and that the femur settles on the insert. Gives the case and what was put right.
///
/// # Errors
/// Those of a run that cannot start.
pub fn check(case_path: &Path, threads: usize) -> Result<(Case, Vec<BuildWarning>), RunError> {
    let case = Case::read(case_path)?;
    let built = build(&case, threads, &Cache::off())?;
    start(&case, built.test)?;
    Ok((case, built.warnings))
}

pub(crate) fn build(case: &Case, threads: usize, cache: &Cache) -> Result<Built, RunError> {
    case.build_kept(threads, cache)
        .map_err(|source| RunError::Build {
            shown: case.at_its_key(&source),
            source,
        })
}

pub(crate) fn start(case: &Case, test: WearTest) -> Result<March, RunError> {
    March::start(test).map_err(|source| RunError::Placement {
        shown: case.placement_at_its_key(&source),
        source,
    })
}
