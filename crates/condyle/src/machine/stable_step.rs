//! How long an explicit step may be.

use super::{
    Machine,
    balance::{Balance, StepSlopes},
    joint_vectors::JointStiffness,
};

/// Part of the stable step that is taken: the load may grow before stability is asked for again.
const SAFETY: f64 = 0.8;

/// How fast a machine can answer: its own frequency and the rate at which it comes to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quickness {
    /// Highest eigenfrequency, or a bound of it, rad/s.
    pub frequency_per_s: f64,
    /// Highest rate at which drag slows it down, 1/s.
    pub drag_per_s: f64,
}

/// A step that is stable with the inertia multiplied by a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StableStep {
    pub step_s: f64,
    pub inertia_factor: f64,
}

impl Quickness {
    /// How fast a machine can answer where it stands, every part of it at rest: there the
    /// regularised friction rises steepest with the rate, and it is what limits the step.
    ///
    /// With M = diag of the inertias, and K and C the derivatives of the balance by positions and
    /// rates, the drag is the largest eigenvalue of M^-1/2 C M^-1/2, and the frequency the root of
    /// the norm of M^-1/2 K M^-1/2, which no eigenvalue exceeds.
    pub fn at_rest(machine: &Machine, balance: &Balance<'_>) -> Self {
        let scale = by_root_of_inertia(machine);
        let scale = scale.matrix();
        let slopes = |rate| StepSlopes {
            rate,
            ..StepSlopes::STILL
        };
        let stiffness = *balance.tangent(slopes(0.0)).matrix();
        let damping = balance.tangent(slopes(1.0)).matrix() - stiffness;
        let drag = scale * (damping + damping.transpose()) * scale / 2.0;
        Self {
            frequency_per_s: (scale * stiffness * scale).norm().sqrt(),
            drag_per_s: drag.symmetric_eigenvalues().max(),
        }
    }

    /// The longest stable step, and more inertia where it is shorter than `least_step_s`.
    ///
    /// Central differences follow an oscillation up to h w = 2; with rates carried on from the two
    /// last half-steps they follow drag up to h c = 1. Both together are stable for h (c + w/2) <= 1.
    /// Inertia times f divides c by f and w by its root.
    pub fn stable_step(self, least_step_s: f64) -> StableStep {
        let (drag, half) = (self.drag_per_s, self.frequency_per_s / 2.0);
        let step_s = SAFETY / (drag + half);
        if step_s >= least_step_s {
            return StableStep {
                step_s,
                inertia_factor: 1.0,
            };
        }
        let linear = least_step_s * half;
        let root = (linear + (linear * linear + 4.0 * SAFETY * least_step_s * drag).sqrt())
            / (2.0 * SAFETY);
        StableStep {
            step_s: least_step_s,
            inertia_factor: root * root,
        }
    }
}

/// 1/sqrt(M) on the diagonal of loaded rows; nothing on the others.
fn by_root_of_inertia(machine: &Machine) -> JointStiffness {
    let mut diagonal = [0.0; 6];
    for j in machine.loaded() {
        diagonal[j] = machine.joints[j].inertia.sqrt().recip();
    }
    JointStiffness::from_diagonal(diagonal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn added_inertia_makes_the_asked_step_just_stable() {
        let quickness = Quickness {
            frequency_per_s: 4000.0,
            drag_per_s: 3e4,
        };
        let factor = quickness.stable_step(1e-3).inertia_factor;
        let heavier = Quickness {
            frequency_per_s: 4000.0 / factor.sqrt(),
            drag_per_s: 3e4 / factor,
        };
        assert!((heavier.stable_step(0.0).step_s / 1e-3 - 1.0).abs() < 1e-12);
    }
}
