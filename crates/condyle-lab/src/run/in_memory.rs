//! A run that is kept in memory alone.

use condyle::{evolve::March, geometry::TriangleMesh, wear::NamedLaw};
use condyle_io::{
    cache::Cache,
    case::{Case, FEMUR_TRIANGLES, SharedBodies},
};

use super::{
    error::RunError,
    event::{Listener, Outcome},
    running::{Run, RunContext, Start},
};

/// How a case is run in memory.
#[derive(Clone, Debug)]
pub struct InMemory {
    /// Threads for the one-time work on a mesh; results do not depend on it.
    pub threads: usize,
    /// Where the one-time work on a mesh is kept for the next run; results do not depend on it.
    pub cache: Cache,
    /// A law of wear that takes the place of the case's; the hash of the inputs does not know it.
    pub wear_law: Option<NamedLaw>,
}

/// Hears of a run as it is kept.
pub trait RunKeeper {
    /// The femur has settled, and nothing is worn; `femur` is its triangles in the femoral frame, those of its
    /// mesh, or about [`FEMUR_TRIANGLES`].
    fn settled(&mut self, march: &March, femur: &TriangleMesh);

    /// An update is done.
    fn updated(&mut self, march: &March);
}

/// Runs a case, and writes no file: `keeper` takes what is wanted of it. The numbers are those of
/// [`run_case`](super::run_case).
///
/// # Errors
/// A bad case, or physics that cannot be solved.
pub fn run_in_memory(
    case: &Case,
    how: &InMemory,
    keeper: &mut dyn RunKeeper,
    on_event: &mut Listener<'_>,
) -> Result<Outcome, RunError> {
    let inputs_blake3 = case.inputs_blake3().map_err(RunError::Inputs)?;
    let means = RunContext {
        threads: how.threads,
        cache: &how.cache,
        bodies: &SharedBodies::default(),
        out: None,
        wear_law: how.wear_law.as_ref(),
    };
    let mut run = Run::begin(case, means, Start::Now, inputs_blake3, on_event)?;
    keeper.settled(&run.march, &run.femur_triangles(FEMUR_TRIANGLES)?);
    let mut keep = |run: &Run<'_>| {
        keeper.updated(&run.march);
        Ok(())
    };
    run.complete(&mut keep, on_event)
}
