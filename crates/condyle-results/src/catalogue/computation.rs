//! The computation: its size, its work and its time.

use super::{Scalar, scalar::scalars};

scalars! { "Computation";
    /// Updates of the geometry. How often wear has moved the surface.
    UPDATES = Scalar::new("updates", "updates", 0).count();

    /// Increments a cycle. Steps in time.
    INCREMENTS = Scalar::new("increments", "increments a cycle", 0).count().listed();

    /// Cycles solved in all. Each update solves until the motion repeats itself, which takes a little more than a cycle.
    CYCLES_SOLVED = Scalar::new("cycles_solved", "cycles solved", 1).exact();

    /// Updates whose motion did not repeat itself within the tolerance.
    CYCLES_NOT_REPEATING = Scalar::new("cycles_not_repeating", "updates that do not repeat", 0).count().listed();

    /// Newton iterations in all. They bring the forces into balance.
    NEWTON_ITERATIONS = Scalar::new("newton_iterations", "Newton iterations", 0).count();

    /// Contact evaluations in all. Each computes force, moment and tangent of the contact at a pose.
    CONTACT_EVALUATIONS = Scalar::new("contact_evaluations", "contact evaluations", 0).count();

    /// Newton iterations of a cycle solved, on average.
    NEWTON_ITERATIONS_PER_CYCLE = Scalar::new("newton_iterations_per_cycle", "Newton iterations a cycle", 0).exact().listed();

    /// Contact evaluations of a cycle solved, on average.
    CONTACT_EVALUATIONS_PER_CYCLE = Scalar::new("contact_evaluations_per_cycle", "contact evaluations a cycle", 0).exact().listed();

    /// Steps in time that were halved. They did not converge, or were not accurate enough.
    STEP_HALVINGS = Scalar::new("step_halvings", "steps halved", 0)
        .count().listed();

    /// Steps of central differences. Of the explicit integrator, where the case asks for it.
    EXPLICIT_STEPS = Scalar::new("explicit_steps", "explicit steps", 0).count().sometimes().listed();

    /// Largest inertia added by the explicit integrator. A part of the machine's own, to allow the step asked for.
    ADDED_INERTIA = Scalar::new("added_inertia", "inertia added", 3)
        .exact().sometimes().listed();

    /// Hexahedra of the insert's mesh.
    HEXAHEDRA = Scalar::new("hexahedra", "hexahedra", 0).count();

    /// Nodes of the articulating surface. Pressure and wear are known there.
    ARTICULATING_NODES = Scalar::new("articulating_nodes", "nodes of the articulating surface", 0).count().listed();

    /// Smallest scaled Jacobian of any update's mesh. 1 is a cube, 0 is flat, below 0 is inverted.
    WORST_QUALITY = Scalar::new("worst_quality", "worst element quality", 3).exact();

    /// Time of the solver. From the case as read to the last update, without files and report; a run that was resumed
    /// has the sum of its parts.
    WALL_S = Scalar::new("wall_s", "time, solver only", 3).exact();
}
