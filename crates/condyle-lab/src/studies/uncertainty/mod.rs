//! How far a test would scatter whose inputs are never quite the same.

mod found;
mod scatter;

use std::{ops::ControlFlow, path::Path};

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_io::{
    cache::Cache,
    case::{Assignment, Case, SharedBodies},
    results::Summary,
};

use super::chance::latin_hypercube;
use super::many_runs::{first_line, in_parallel};
use crate::{
    RunError,
    run::{self, InMemory, Outcome, RunKeeper, marched, run_in_memory},
};
use scatter::{Scatter, deviations, scatters};

pub use found::{Input, Spread, Uncertainty};

/// How an uncertainty is found.
#[derive(Clone, Copy, Debug)]
pub struct UncertaintyOptions {
    /// Runs with other inputs; at least 2.
    pub runs: usize,
    /// Of the chance by which inputs are chosen.
    pub seed: u64,
    /// Runs at the same time; results do not depend on it.
    pub threads: usize,
}

/// Runs the case at `case_path` as it is, with its estimate of the error, and again with inputs that scatter:
/// friction, loads, springs, placement, thickness, modulus and wear factor, as far as the case has them. The inputs
/// are a Latin hypercube of normal distributions cut off at three standard deviations, and know nothing of each
/// other. Nothing is written.
///
/// `tell` hears of every run with other inputs that is done, from any thread.
///
/// # Errors
/// A case that cannot be run as it is. A run with other inputs that fails is counted among the results.
pub fn uncertainty(
    case_path: &Path,
    options: UncertaintyOptions,
    tell: &(dyn Fn() + Sync),
) -> Result<Uncertainty, RunError> {
    let case = Case::read(case_path)?;
    let as_given = with_error(&case)?;
    let (scatters, left_out): (Vec<_>, Vec<_>) =
        scatters().partition(|scatter| takes(case_path, &case, scatter));
    let points = drawn(options, scatters.len());
    let bodies = SharedBodies::default();
    let ran = in_parallel(points.len(), options.threads, |index| {
        let set = off_by(&case, &scatters, &points[index]);
        let found = ran_with(case_path, &set, &bodies).map_err(|error| first_line(&error));
        tell();
        found
    });
    let inputs = scatters.iter().map(|scatter| Input::of(scatter)).collect();
    let mut found = Uncertainty::of(&as_given, inputs, &points, &ran);
    found.seed = options.seed;
    found.left_out = left_out.iter().map(|scatter| scatter.name).collect();
    Ok(found)
}

/// Whether a case has keys of a scatter: it takes them as they are.
fn takes(case_path: &Path, case: &Case, scatter: &Scatter) -> bool {
    let set = scatter.off_by(case, 0.0);
    !set.is_empty() && run::changed(case_path, &set).is_ok()
}

/// For each run, by how many standard deviations each input is off.
fn drawn(options: UncertaintyOptions, inputs: usize) -> Vec<Vec<f64>> {
    let mut points = latin_hypercube(options.runs, inputs, options.seed);
    let values = points.iter_mut().flatten();
    values.for_each(|share| *share = deviations(*share));
    points
}

/// What inputs that are off by so many standard deviations set.
fn off_by(case: &Case, scatters: &[&Scatter], point: &[f64]) -> Vec<Assignment> {
    let inputs = scatters.iter().zip(point);
    inputs
        .flat_map(|(scatter, deviations)| scatter.off_by(case, *deviations))
        .collect()
}

/// A run with other values.
fn ran_with(
    case_path: &Path,
    set: &[Assignment],
    bodies: &SharedBodies,
) -> Result<Summary, RunError> {
    let other = run::changed(case_path, set)?;
    marched(&other, &Cache::of_user(), bodies)
}

/// The summary of a case, with its estimate of the error if it asks for one.
fn with_error(case: &Case) -> Result<Summary, RunError> {
    let how = InMemory {
        threads: 1,
        cache: Cache::of_user(),
        wear_law: None,
    };
    let outcome = run_in_memory(case, &how, &mut Nothing, &mut |_| ControlFlow::Continue(()))?;
    match outcome {
        Outcome::Done(summary) | Outcome::DoneBefore(summary) => Ok(*summary),
        Outcome::Interrupted(_) => unreachable!("nobody asks it to stop"),
    }
}

/// Keeps nothing of a run.
struct Nothing;

impl RunKeeper for Nothing {
    fn settled(&mut self, _: &March, _: &TriangleMesh) {}

    fn updated(&mut self, _: &March) {}
}
