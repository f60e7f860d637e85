//! Explicit steps of time by central differences: the balance of the implicit method with nothing to solve.

use super::{
    Chain, JointIndex, Kinematics, Machine, MachineState, SolverCounters,
    balance::{Balance, StepSlopes},
    joint_vectors::JointStiffness,
};
use crate::{
    contact::{ContactModel, NotBorne},
    spatial::RelativeMotion,
};

/// Steps after which stability is asked for again; each time costs one more contact evaluation.
const STEPS_PER_STABILITY: usize = 16;
/// Rates beyond which the motion has left all bounds, mm/s or rad/s.
const FASTEST: f64 = 1e6;

/// Why explicit steps end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NoStep {
    /// A loaded joint without inertia takes no explicit step.
    NoInertia(JointIndex),
    /// The motion left all bounds.
    Unstable { phase: f64, positions: [f64; 6] },
    /// The insert does not bear the load.
    NotBorne { phase: f64, why: NotBorne },
}

/// Everything that explicit steps need beside the state.
pub(super) struct Explicit<'a> {
    pub machine: &'a Machine,
    pub chain: &'a Chain,
    pub contact: &'a mut dyn ContactModel,
    /// Inertia is added where the stable step is shorter, s; 0 adds none.
    pub least_step_s: f64,
    pub counters: &'a mut SolverCounters,
}

impl Explicit<'_> {
    /// The state at the phase `to`, in as many equal steps as it takes, their length asked for again
    /// after every few of them; and the femur's motion past the insert there. The contact accepts every
    /// step, and its last evaluation is at the positions returned.
    pub fn advance(
        &mut self,
        state: &MachineState,
        to: f64,
    ) -> Result<(MachineState, RelativeMotion), NoStep> {
        self.check_inertia()?;
        let (mut now, mut phase) = (state.now, state.phase);
        loop {
            let stable = self.quickness(&now).stable_step(self.least_step_s);
            self.counters.added_inertia =
                (stable.inertia_factor - 1.0).max(self.counters.added_inertia);
            let rest_s = (to - phase) / self.machine.frequency_hz;
            let mut left = ((rest_s / stable.step_s).ceil() as usize).max(1);
            let step = (to - phase) / left as f64;
            for _ in 0..left.min(STEPS_PER_STABILITY) {
                left -= 1;
                phase = if left == 0 { to } else { phase + step };
                let (next, motion) = self.step(&now, phase, step, stable.inertia_factor)?;
                let settled = self.contact.settle(&motion);
                // A step is so short that what the contact finds may count from the next one on.
                settled.map_err(|why| NoStep::NotBorne { phase, why })?;
                self.contact.accept(&motion);
                now = next;
                if left == 0 {
                    return Ok((ended(to, now), motion));
                }
            }
        }
    }

    /// One step of `step` of the cycle that ends at `phase`, and the femur's motion there.
    ///
    /// v' = v + h/2 a, q1 = q + h v', a1 = a(q1, v' + h/2 a), v1 = v' + h/2 a1: leapfrog, the rates
    /// kept at whole steps; what depends on rates is asked with rates that are second order too.
    fn step(
        &mut self,
        now: &Kinematics,
        phase: f64,
        step: f64,
        inertia_factor: f64,
    ) -> Result<(Kinematics, RelativeMotion), NoStep> {
        let machine = self.machine;
        let half_s = step / machine.frequency_hz / 2.0;
        let mut next = predicted(now, half_s);
        machine.drive(phase, &mut next.positions, &mut next.rates);
        let loads = machine.loads_at(phase);
        let balance = self.balance(next);
        let residual = balance.residual(&loads);
        for j in machine.loaded() {
            let inertia = inertia_factor * machine.joints[j].inertia;
            next.accelerations[j] = -residual[j] / inertia;
            next.rates[j] = now.rates[j] + half_s * (now.accelerations[j] + next.accelerations[j]);
        }
        let motion = balance.motion_at(&next.rates);
        self.counters.explicit_steps += 1;
        let is_kept = |rate: &f64| rate.abs() <= FASTEST;
        if !next.rates.iter().all(is_kept) {
            let positions = now.positions;
            return Err(NoStep::Unstable { phase, positions });
        }
        Ok((next, motion))
    }

    fn balance(&mut self, kinematics: Kinematics) -> Balance<'_> {
        self.counters.contact_evaluations += 1;
        Balance::new(self.machine, self.chain, self.contact, kinematics)
    }

    fn quickness(&mut self, now: &Kinematics) -> Quickness {
        let machine = self.machine;
        let still = Kinematics {
            rates: [0.0; 6],
            ..*now
        };
        Quickness::at_rest(machine, &self.balance(still))
    }

    fn check_inertia(&self) -> Result<(), NoStep> {
        let without = |&j: &usize| self.machine.joints[j].inertia <= 0.0;
        self.machine
            .loaded()
            .find(without)
            .map_or(Ok(()), |j| Err(NoStep::NoInertia(JointIndex::ALL[j])))
    }
}

/// A state after explicit steps: what a two-step method remembers is lost.
fn ended(phase: f64, now: Kinematics) -> MachineState {
    MachineState {
        phase,
        now,
        before: None,
    }
}

/// Joints at the end of a step of twice `half_s`, their rates as if accelerations lasted.
fn predicted(now: &Kinematics, half_s: f64) -> Kinematics {
    let mut next = Kinematics {
        accelerations: [0.0; 6],
        ..*now
    };
    for j in 0..6 {
        let change = half_s * now.accelerations[j];
        next.positions[j] += 2.0 * half_s * (now.rates[j] + change);
        next.rates[j] += 2.0 * change;
    }
    next
}

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
    use crate::{
        Vec3,
        contact::{ContactResult, Linearization, MAX_REGIONS, Response, Tangent},
        machine::{
            CycleError, Drive, Waveform,
            knee::{IS, KNEE},
        },
        spatial::{Mat6, Wrench, WrenchByTwist},
    };

    const MASS: f64 = 0.005;

    /// A spring and a dashpot under the femur, along y.
    struct Support {
        stiffness: f64,
        drag: f64,
        /// Steps accepted.
        accepted: u64,
    }

    fn support(stiffness: f64, drag: f64) -> Support {
        Support {
            stiffness,
            drag,
            accepted: 0,
        }
    }

    impl Linearization for Support {
        fn tangent(&self) -> Tangent {
            let along_y = |value| {
                let mut matrix = Mat6::zeros();
                matrix[(4, 4)] = value;
                WrenchByTwist::new(matrix)
            };
            Tangent {
                by_pose: along_y(self.stiffness),
                by_twist: along_y(self.drag),
            }
        }
    }

    impl ContactModel for Support {
        fn node_count(&self) -> usize {
            0
        }

        fn respond(&mut self, motion: &RelativeMotion) -> Response<'_> {
            let (height, speed) = (motion.pose.translation.y, motion.twist.linear.y);
            let force = Vec3::y() * (self.stiffness * height + self.drag * speed);
            let wrench = Wrench::new(Vec3::zeros(), force);
            Response::new(wrench, [Vec3::zeros(); MAX_REGIONS], self)
        }

        fn accept(&mut self, _: &RelativeMotion) {
            self.accepted += 1;
        }

        fn evaluate(&mut self, _: &RelativeMotion) -> ContactResult {
            ContactResult::default()
        }
    }

    /// A machine that moves IS alone, without load.
    fn machine(inertia: f64) -> Machine {
        let mut machine = Machine::new(&KNEE);
        machine
            .joints
            .iter_mut()
            .for_each(|joint| joint.damping = 0.0);
        let joint = machine.joint_mut(IS);
        joint.inertia = inertia;
        joint.drive = Drive::Loaded(Waveform::constant(0.0));
        machine
    }

    /// The state after 0.1 s from 1 mm above rest.
    fn released(
        support: Support,
        inertia: f64,
        least_step_s: f64,
        counters: &mut SolverCounters,
    ) -> Result<MachineState, NoStep> {
        let machine = machine(inertia);
        let mut start = MachineState::at_rest(&machine, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        start.now.accelerations[IS.place()] = -support.stiffness / inertia;
        let mut contact = support;
        let mut explicit = Explicit {
            machine: &machine,
            chain: &Chain::new(&machine, Vec3::zeros(), (0.0, 0.0)),
            contact: &mut contact,
            least_step_s,
            counters,
        };
        let (end, motion) = explicit.advance(&start, 0.1)?;
        let steps = explicit.counters.explicit_steps;
        assert_eq!(contact.accepted, steps, "every step is accepted");
        assert_eq!(motion.pose.translation.y, end.now.positions[IS.place()]);
        Ok(end)
    }

    #[test]
    fn verify_damped_oscillation_to_second_order() {
        let (stiffness, drag) = (50.0, 0.2);
        let machine = machine(MASS);
        let after = |steps: u32| {
            let mut now = MachineState::at_rest(&machine, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]).now;
            now.accelerations[IS.place()] = -stiffness / MASS;
            let mut explicit = Explicit {
                machine: &machine,
                chain: &Chain::new(&machine, Vec3::zeros(), (0.0, 0.0)),
                contact: &mut support(stiffness, drag),
                least_step_s: 0.0,
                counters: &mut SolverCounters::default(),
            };
            for _ in 0..steps {
                let step = 0.1 / f64::from(steps);
                now = explicit.step(&now, 0.0, step, 1.0).unwrap().0;
            }
            now.positions[IS.place()]
        };
        let decay: f64 = drag / (2.0 * MASS);
        let frequency = (stiffness / MASS - decay * decay).sqrt();
        let (sine, cosine) = (frequency * 0.1).sin_cos();
        let exact = (-decay * 0.1).exp() * (cosine + decay / frequency * sine);
        let [coarse, fine] = [100, 200].map(|steps| (after(steps) - exact).abs());
        assert!(coarse < 2e-3, "{coarse}");
        assert!((coarse / fine - 4.0).abs() < 0.3, "{}", coarse / fine);
    }

    #[test]
    fn whatever_limits_the_step_it_is_stable() {
        for (stiffness, drag) in [
            (1e5, 0.0),
            (0.0, 200.0),
            (1e5, 20.0),
            (1e5, 60.0),
            (1e3, 200.0),
        ] {
            let end = released(
                support(stiffness, drag),
                MASS,
                0.0,
                &mut SolverCounters::default(),
            )
            .unwrap();
            let amplitude = end.now.positions[IS.place()].abs();
            assert!(
                amplitude < 1.2,
                "{stiffness} N/mm, {drag} N s/mm: {amplitude} mm"
            );
        }
    }

    #[test]
    fn inertia_is_added_until_the_asked_step_is_stable() {
        let mut counters = SolverCounters::default();
        let end = released(support(1e5, 60.0), MASS, 1e-3, &mut counters).unwrap();
        assert_eq!(counters.explicit_steps, 100);
        assert!(counters.added_inertia > 10.0, "{counters:?}");
        assert!(end.now.positions[IS.place()].abs() < 1.2, "{end:?}");
    }

    #[test]
    fn a_loaded_freedom_without_inertia_is_refused() {
        let refused = released(support(1.0, 0.0), 0.0, 0.0, &mut SolverCounters::default());
        assert_eq!(
            CycleError::of_explicit(&KNEE, &refused.unwrap_err()).to_string(),
            "the explicit integrator needs inertia on every loaded freedom, and InferoSuperior has none; give it \
             some, or take the implicit integrator"
        );
    }

    #[test]
    fn a_motion_that_leaves_all_bounds_is_an_error() {
        let lost = released(
            support(-1e4, 0.0),
            1e-5,
            0.0,
            &mut SolverCounters::default(),
        );
        let message = CycleError::of_explicit(&KNEE, &lost.unwrap_err()).to_string();
        assert!(
            message.starts_with("explicit steps leave all bounds at "),
            "{message}"
        );
    }

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
