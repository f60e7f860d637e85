//! The computation: its size, its work and its time.

use condyle::machine::SolverCounters;

use super::finished::FinishedRun;
use super::{Scalar, scalar::scalars};

scalars! { "Computation";
    /// Updates of the geometry. Number of times that wear has moved the surface.
    UPDATES = Scalar::new("updates", "updates", 0, |run| run.state().updates.len() as f64)
        .count();

    /// Increments per cycle. Steps in time.
    INCREMENTS = Scalar::new("increments", "increments a cycle", 0, |run| run.march.test().time.increments as f64)
        .count()
        .listed();

    /// Number of cycles solved. Each update, and the final cycle, is solved until the motion is periodic, which takes a little more than a cycle.
    CYCLES_SOLVED = Scalar::new("cycles_solved", "cycles solved", 1, cycles_solved)
        .exact()
        .continued();

    /// Updates, and the final cycle, whose motion did not become periodic within the tolerance.
    CYCLES_NOT_REPEATING = Scalar::new("cycles_not_repeating", "updates and final cycle that do not repeat", 0, |run| run.state().not_repeating as f64)
        .count()
        .listed();

    /// Number of Newton iterations. They bring the forces into balance.
    NEWTON_ITERATIONS = Scalar::new("newton_iterations", "Newton iterations", 0, |run| run.state().counters.newton_iterations as f64)
        .count();

    /// Number of contact evaluations. Each computes force, moment and tangent of the contact at a pose.
    CONTACT_EVALUATIONS = Scalar::new("contact_evaluations", "contact evaluations", 0, |run| run.state().counters.contact_evaluations as f64)
        .count();

    /// Mean number of Newton iterations per solved cycle.
    NEWTON_ITERATIONS_PER_CYCLE = Scalar::new("newton_iterations_per_cycle", "Newton iterations a cycle", 0, |run| run.state().counters.newton_iterations as f64 / cycles_solved(run))
        .exact()
        .printed()
        .continued();

    /// Mean number of contact evaluations per solved cycle.
    CONTACT_EVALUATIONS_PER_CYCLE = Scalar::new("contact_evaluations_per_cycle", "contact evaluations a cycle", 0, |run| run.state().counters.contact_evaluations as f64 / cycles_solved(run))
        .exact()
        .printed()
        .continued();

    /// Halved steps in time. Steps that did not converge or were not accurate enough.
    STEP_HALVINGS = Scalar::new("step_halvings", "steps halved", 0, |run| run.state().counters.halvings as f64)
        .count()
        .listed();

    /// Steps of central differences. Only with the explicit integrator.
    EXPLICIT_STEPS = Scalar::sometimes("explicit_steps", "explicit steps", 0, |run| Some(explicit(run)?.explicit_steps as f64))
        .count()
        .listed();

    /// Largest inertia added by the explicit integrator. Relative to the machine's own; it makes the requested step stable.
    ADDED_INERTIA = Scalar::sometimes("added_inertia", "inertia added", 3, |run| Some(explicit(run)?.added_inertia))
        .exact()
        .listed();

    /// Hexahedra of the insert's mesh.
    HEXAHEDRA = Scalar::new("hexahedra", "hexahedra", 0, |run| run.march.insert().mesh().hexes.len() as f64)
        .count();

    /// Nodes of the articulating surface. Pressure and wear are computed there.
    ARTICULATING_NODES = Scalar::new("articulating_nodes", "nodes of the articulating surface", 0, |run| run.march.insert().surface_nodes().len() as f64)
        .count()
        .listed();

    /// Smallest scaled Jacobian of the mesh at any update. 1 for a brick, 0 for a flat element, below 0 for an inverted one.
    WORST_QUALITY = Scalar::new("worst_quality", "worst element quality", 3, |run| {
        let updates = run.state().updates.iter();
        updates.map(|update| update.worst_quality).fold(f64::INFINITY, f64::min)
    })
        .exact()
        .continued();

    /// Time of the solver. From the parsed case to the last update, without files and report; for a resumed run, the sum of its parts.
    WALL_S = Scalar::new("wall_s", "time, solver only", 3, |run| run.facts.wall_s)
        .exact();
}

fn cycles_solved(run: &FinishedRun<'_>) -> f64 {
    run.state().increments_solved as f64 / run.march.test().time.increments as f64
}

/// Returns the counters of a run with the explicit integrator; `None` for other runs.
fn explicit<'a>(run: &FinishedRun<'a>) -> Option<&'a SolverCounters> {
    Some(&run.state().counters).filter(|counters| counters.explicit_steps > 0)
}
