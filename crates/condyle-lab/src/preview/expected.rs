//! What a run will need: memory by its counts, and time by how long a contact takes here.

use std::time::{Duration, Instant};

use condyle::{contact::ContactMemory, evolve::March, spatial::RelativeMotion};
use condyle_io::case::{Case, Update};
use serde::Serialize;

use crate::{at_rest::AtRest, run::memory_mb};

/// Cycles solved for an update: some are solved again until they repeat themselves.
const CYCLES_AN_UPDATE: f64 = 1.15;
/// Contact evaluations for an increment.
const EVALUATIONS_AN_INCREMENT: f64 = 2.3;
/// Updates that a march takes which finds them itself, about.
const OWN_UPDATES: f64 = 8.0;
/// Evaluations that are timed.
const TIMED: usize = 5;

/// What a run will need, about.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Memory at its highest, MB.
    pub memory_mb: f64,
    /// Memory that the case allows, MB.
    pub memory_allowed_mb: f64,
    /// Time on this computer, s.
    pub time_s: f64,
}

impl Expected {
    /// Of a march that was built in `built_in`.
    pub(super) fn of(case: &Case, march: &March, at_rest: &AtRest, built_in: Duration) -> Self {
        Self {
            memory_mb: memory_mb(case, march, at_rest),
            memory_allowed_mb: 1e3 * case.limits.memory_gb,
            time_s: built_in.as_secs_f64() + solving_s(case, march, at_rest),
        }
    }
}

/// How long the cycles take, by how long the contact at rest takes to answer.
fn solving_s(case: &Case, march: &March, at_rest: &AtRest) -> f64 {
    let updates = match &case.march.update {
        Update::Fixed(fixed) => fixed.updates as f64,
        Update::Auto(_) => OWN_UPDATES,
    };
    let increments = march.test().time.increments as f64;
    let evaluations = updates * CYCLES_AN_UPDATE * increments * EVALUATIONS_AN_INCREMENT;
    let again = if case.accuracy.estimate { 1.6 } else { 1.0 };
    again * evaluations * evaluation_s(march, at_rest)
}

/// Seconds in which the contact at rest answers, with its derivatives: the shortest of a few.
fn evaluation_s(march: &March, at_rest: &AtRest) -> f64 {
    let surface = march.insert().surface();
    let memory = ContactMemory::default();
    let mut contact = march.test().contact.contact(march.bodies(&surface), memory);
    let motion = RelativeMotion::at_rest(at_rest.pose);
    let mut shortest = Duration::MAX;
    for _ in 0..TIMED {
        let began = Instant::now();
        let tangent = contact.respond(&motion).tangent();
        std::hint::black_box(tangent);
        shortest = shortest.min(began.elapsed());
    }
    shortest.as_secs_f64()
}
