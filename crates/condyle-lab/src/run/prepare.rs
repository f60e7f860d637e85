//! From a case to a march that is ready to go.

use std::path::Path;

use condyle::evolve::{March, WearTest};
use condyle_io::{
    cache::Cache,
    case::{Assignment, BuildWarning, Built, Case, SharedBodies},
};

use super::{bridged::check_at_rest, error::RunError, memory::check_memory};

/// Checks the case at `case_path` as far as a run would go before its first cycle: the file, the
/// meshes, and that the femur settles on the insert. Gives the case and what was put right.
///
/// # Errors
/// Those of a run that cannot start.
pub fn check(case_path: &Path, threads: usize) -> Result<(Case, Vec<BuildWarning>), RunError> {
    check_changed(case_path, &[], threads)
}

/// Checks the case at `case_path` with some of its values changed, as [`check`] does.
///
/// # Errors
/// As [`check`], and a change that cannot be made.
pub fn check_changed(
    case_path: &Path,
    changes: &[Assignment],
    threads: usize,
) -> Result<(Case, Vec<BuildWarning>), RunError> {
    let case = changed(case_path, changes)?;
    let built = build(&case, threads, &Cache::off())?;
    start(&case, built.test, &built.warnings)?;
    Ok((case, built.warnings))
}

/// The bodies of a case with the femur settled on the insert, before any cycle.
///
/// # Errors
/// Those of a run that cannot start.
pub fn settled(case: &Case, threads: usize, cache: &Cache) -> Result<March, RunError> {
    let built = build(case, threads, cache)?;
    start(case, built.test, &built.warnings)
}

/// The case at `case_path` with some of its values changed.
pub(crate) fn changed(case_path: &Path, changes: &[Assignment]) -> Result<Case, RunError> {
    Ok(Case::read_changed(case_path, changes)?)
}

pub(crate) fn build(case: &Case, threads: usize, cache: &Cache) -> Result<Built, RunError> {
    build_sharing(case, threads, cache, &SharedBodies::default())
}

/// The bodies of a case, of which it may have some in common with other cases.
pub(crate) fn build_sharing(
    case: &Case,
    threads: usize,
    cache: &Cache,
    bodies: &SharedBodies,
) -> Result<Built, RunError> {
    case.build_sharing(threads, cache, bodies)
        .map_err(|source| RunError::of_build(case, source))
}

pub(crate) fn start(
    case: &Case,
    test: WearTest,
    warnings: &[BuildWarning],
) -> Result<March, RunError> {
    let march = March::start(test).map_err(|source| RunError::Placement {
        shown: case.placement_at_its_key(&source, warnings),
        source,
    })?;
    check_memory(case, &march)?;
    check_at_rest(case, &march, warnings)?;
    Ok(march)
}
