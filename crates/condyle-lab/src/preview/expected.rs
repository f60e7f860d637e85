//! What a run will need: memory by its counts, and time by how long a contact takes here.

use std::time::{Duration, Instant};

use condyle::{
    Vec3,
    contact::{ContactMemory, ContactModel},
    evolve::March,
    spatial::{Pose, RelativeMotion},
};
use condyle_io::case::{Case, Update};
use serde::Serialize;

use crate::{
    at_rest::AtRest,
    run::{mean_load_n, memory_mb},
};

/// Cycles solved for an update: some are solved again until they repeat themselves.
const CYCLES_AN_UPDATE: f64 = 1.15;
/// Contact evaluations for an increment.
const EVALUATIONS_AN_INCREMENT: f64 = 2.3;
/// Updates that a march takes which finds them itself, about.
const OWN_UPDATES: f64 = 8.0;
/// Evaluations that are timed, on a path of so many steps, each so long, mm: as in a cycle other nodes press at each.
const TIMED: usize = 8;
const STEP_MM: f64 = 0.1;
/// Lowerings of the femur until it carries the mean load of the cycle.
const LOWERINGS: usize = 8;

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

/// How long the cycles take, by how long the contact under the mean load takes to answer.
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

/// Seconds in which the contact under the mean load answers, with its derivatives: the shorter of two times on a path.
fn evaluation_s(march: &March, at_rest: &AtRest) -> f64 {
    let surface = march.insert().surface();
    let memory = ContactMemory::default();
    let mut contact = march.test().contact.contact(march.bodies(&surface), memory);
    let pose = lowered(contact.as_mut(), at_rest, mean_load_n(march));
    let mut once = || {
        let began = Instant::now();
        contact.begin_cycle();
        for step in 0..TIMED {
            let along = Vec3::new(STEP_MM * step as f64, 0.0, 0.0);
            let motion =
                RelativeMotion::at_rest(Pose::new(pose.rotation, pose.translation + along));
            contact.begin_increment(step);
            std::hint::black_box(contact.respond(&motion).tangent());
            // An insert that flows takes its time to settle. A load that it does not carry is told by the run.
            let settled = contact.settle(&motion);
            std::hint::black_box(settled.is_ok());
            contact.accept(&motion);
        }
        began.elapsed().as_secs_f64() / TIMED as f64
    };
    // What a contact computes once is no part of the second time.
    once().min(once())
}

/// The pose at rest with the femur lowered until it carries a load, about.
fn lowered(contact: &mut dyn ContactModel, at_rest: &AtRest, load_n: f64) -> Pose {
    let mut pose = at_rest.pose;
    for _ in 0..LOWERINGS {
        let response = contact.respond(&RelativeMotion::at_rest(pose));
        let missing_n = load_n + response.wrench.force.y;
        let stiffness_n_per_mm = response.tangent().by_pose.matrix[(4, 4)].abs();
        if missing_n.abs() < 0.05 * load_n || stiffness_n_per_mm < 1.0 {
            break;
        }
        pose.translation.y -= (missing_n / stiffness_n_per_mm).clamp(-0.1, 0.1);
    }
    pose
}
