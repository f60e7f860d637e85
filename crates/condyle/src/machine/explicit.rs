//! Steps of time by central differences: the balance of the implicit method with nothing to solve.

use super::joint_numbers::{Mat6, Vec6};
use super::{
    Chain, Drive, FREEDOMS, Freedom, Machine,
    balance::{Balance, Kinematics, StepSlopes},
    integrator::{MachineState, SolverCounters, drive, loads_at},
};
use crate::contact::ContactModel;

/// Part of the stable step that is taken: the load may grow between two looks at it.
const SAFETY: f64 = 0.8;
/// Steps between two looks at what is stable; each look costs one more contact evaluation.
const STEPS_BETWEEN_LOOKS: usize = 16;
/// Rates beyond which the motion has left all bounds, mm/s or rad/s.
const FASTEST: f64 = 1e6;

/// Why explicit steps end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NoStep {
    /// A loaded freedom without inertia takes no explicit step.
    NoInertia(Freedom),
    /// The motion left all bounds.
    Unstable { phase: f64, positions: [f64; 6] },
}

/// How fast a machine can answer: its own frequency and the rate at which it comes to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quickness {
    /// Highest eigenfrequency, or a bound of it, rad/s.
    frequency_per_s: f64,
    /// Highest rate at which drag slows it down, 1/s.
    drag_per_s: f64,
}

/// A step that is stable with the inertia multiplied by a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StableStep {
    step_s: f64,
    inertia_factor: f64,
}

impl Quickness {
    /// The longest stable step, and more inertia where it is shorter than `least_step_s`.
    ///
    /// Central differences follow an oscillation up to h w = 2; with rates carried on from the two
    /// last half-steps they follow drag up to h c = 1. Both together are stable for h (c + w/2) <= 1.
    /// Inertia times f divides c by f and w by its root.
    fn stable_step(self, least_step_s: f64) -> StableStep {
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
    /// The state at the phase `to`, in as many equal steps as it takes, looked at again after every
    /// few of them. The last contact evaluation is that of the state returned.
    pub fn advance(&mut self, state: &MachineState, to: f64) -> Result<MachineState, NoStep> {
        self.check_inertia()?;
        let (mut now, mut phase) = (state.now, state.phase);
        let mut left = usize::MAX;
        while left > 0 {
            let stable = self.quickness(&now).stable_step(self.least_step_s);
            self.counters.added_inertia =
                (stable.inertia_factor - 1.0).max(self.counters.added_inertia);
            let rest_s = (to - phase) / self.machine.frequency_hz;
            left = ((rest_s / stable.step_s).ceil() as usize).max(1);
            let step = (to - phase) / left as f64;
            for _ in 0..left.min(STEPS_BETWEEN_LOOKS) {
                left -= 1;
                phase = if left == 0 { to } else { phase + step };
                now = self.step(&now, phase, step, stable.inertia_factor)?;
            }
        }
        Ok(MachineState {
            phase: to,
            now,
            before: None,
        })
    }

    /// One step of `step` of the cycle that ends at `phase`.
    ///
    /// v' = v + h/2 a, q1 = q + h v', a1 = a(q1, v' + h/2 a), v1 = v' + h/2 a1: leapfrog, the rates
    /// kept at whole steps; what depends on rates is asked with rates that are second order too.
    fn step(
        &mut self,
        now: &Kinematics,
        phase: f64,
        step: f64,
        inertia_factor: f64,
    ) -> Result<Kinematics, NoStep> {
        let half_s = step / self.machine.frequency_hz / 2.0;
        let mut next = Kinematics {
            accelerations: [0.0; 6],
            ..*now
        };
        for j in 0..6 {
            let change = half_s * now.accelerations[j];
            next.positions[j] += 2.0 * half_s * (now.rates[j] + change);
            next.rates[j] += 2.0 * change;
        }
        drive(self.machine, phase, &mut next.positions, &mut next.rates);
        let loads = loads_at(self.machine, phase);
        let residual = self.balance(next).residual(&loads);
        for j in loaded(self.machine) {
            let inertia = inertia_factor * self.machine.freedoms[j].inertia;
            next.accelerations[j] = -residual[j] / inertia;
            next.rates[j] = now.rates[j] + half_s * (now.accelerations[j] + next.accelerations[j]);
        }
        self.counters.explicit_steps += 1;
        let is_kept = |rate: &f64| rate.abs() <= FASTEST;
        if !next.rates.iter().all(is_kept) {
            let positions = now.positions;
            return Err(NoStep::Unstable { phase, positions });
        }
        Ok(next)
    }

    fn balance(&mut self, kinematics: Kinematics) -> Balance<'_> {
        self.counters.contact_evaluations += 1;
        Balance::new(self.machine, self.chain, self.contact, kinematics)
    }

    /// How fast the machine can answer where it stands, every part of it at rest: there the
    /// regularised friction rises steepest with the rate, and it is what limits the step.
    ///
    /// With M = diag of the inertias, and K and C the derivatives of the balance by positions and
    /// rates, the drag is the largest eigenvalue of M^-1/2 C M^-1/2, and the frequency the root of
    /// the norm of M^-1/2 K M^-1/2, which no eigenvalue exceeds.
    fn quickness(&mut self, now: &Kinematics) -> Quickness {
        let scale = by_root_of_inertia(self.machine);
        let balance = self.balance(Kinematics {
            rates: [0.0; 6],
            ..*now
        });
        let slopes = |rate| StepSlopes {
            rate,
            acceleration: 0.0,
        };
        let stiffness = balance.tangent(slopes(0.0));
        let damping = balance.tangent(slopes(1.0)) - stiffness;
        let scaled = |matrix: Mat6| scale * matrix * scale;
        let drag = scaled(damping + damping.transpose()) / 2.0;
        Quickness {
            frequency_per_s: scaled(stiffness).norm().sqrt(),
            drag_per_s: drag.symmetric_eigenvalues().max(),
        }
    }

    fn check_inertia(&self) -> Result<(), NoStep> {
        let without = |&j: &usize| self.machine.freedoms[j].inertia <= 0.0;
        match loaded(self.machine).find(without) {
            Some(j) => Err(NoStep::NoInertia(FREEDOMS[j])),
            None => Ok(()),
        }
    }
}

/// Rows that are loaded: their positions follow from the balance.
fn loaded(machine: &Machine) -> impl Iterator<Item = usize> + '_ {
    (0..6).filter(|&j| matches!(machine.freedoms[j].drive, Drive::Loaded(_)))
}

/// 1/sqrt(M) on the diagonal of loaded rows; nothing on the others.
fn by_root_of_inertia(machine: &Machine) -> Mat6 {
    let mut diagonal = Vec6::zeros();
    for j in loaded(machine) {
        diagonal[j] = machine.freedoms[j].inertia.sqrt().recip();
    }
    Mat6::from_diagonal(&diagonal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Vec3,
        contact::{RelativeMotion, Tangent, TouchedNode},
        machine::{CycleError, FreedomSettings, Waveform},
    };

    const MASS: f64 = 0.005;
    const IS: usize = Freedom::InferoSuperior as usize;

    /// A spring and a dashpot under the femur, along y.
    struct Support {
        stiffness: f64,
        drag: f64,
    }

    impl ContactModel for Support {
        fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
            let force = self.stiffness * motion.pose.translation.y + self.drag * motion.twist[4];
            Vec6::new(0.0, 0.0, 0.0, 0.0, force, 0.0)
        }

        fn tangent(&self) -> Tangent {
            let along_y = |value| {
                let mut matrix = Mat6::zeros();
                matrix[(4, 4)] = value;
                matrix
            };
            Tangent {
                by_pose: along_y(self.stiffness),
                by_twist: along_y(self.drag),
            }
        }

        fn mean_slip(&self) -> [Vec3; 2] {
            [Vec3::zeros(); 2]
        }

        fn node_count(&self) -> usize {
            0
        }

        fn touched(&mut self, _: &RelativeMotion) -> Vec<TouchedNode> {
            Vec::new()
        }

        fn peak_pressure_mpa(&self, _: &RelativeMotion, _: &[TouchedNode]) -> f64 {
            0.0
        }
    }

    /// A machine that moves IS alone, without load.
    fn machine(inertia: f64) -> Machine {
        let row = |drive| FreedomSettings {
            drive,
            inertia,
            damping: 0.0,
        };
        let mut freedoms = [(); 6].map(|()| row(Drive::Locked(0.0)));
        freedoms[IS] = row(Drive::Loaded(Waveform::constant(0.0)));
        Machine {
            freedoms,
            ap_springs: Vec::new(),
            frequency_hz: 1.0,
            vv_axis_mm: (0.0, 0.0),
            ie_axis_mm: (0.0, 0.0),
        }
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
        start.now.accelerations[IS] = -support.stiffness / inertia;
        let mut contact = support;
        let mut explicit = Explicit {
            machine: &machine,
            chain: &Chain::new(&machine, Vec3::zeros(), (0.0, 0.0)),
            contact: &mut contact,
            least_step_s,
            counters,
        };
        explicit.advance(&start, 0.1)
    }

    #[test]
    fn verify_damped_oscillation_to_second_order() {
        let (stiffness, drag) = (50.0, 0.2);
        let machine = machine(MASS);
        let after = |steps: u32| {
            let mut now = MachineState::at_rest(&machine, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]).now;
            now.accelerations[IS] = -stiffness / MASS;
            let mut explicit = Explicit {
                machine: &machine,
                chain: &Chain::new(&machine, Vec3::zeros(), (0.0, 0.0)),
                contact: &mut Support { stiffness, drag },
                least_step_s: 0.0,
                counters: &mut SolverCounters::default(),
            };
            for _ in 0..steps {
                now = explicit
                    .step(&now, 0.0, 0.1 / f64::from(steps), 1.0)
                    .unwrap();
            }
            now.positions[IS]
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
            let support = Support { stiffness, drag };
            let end = released(support, MASS, 0.0, &mut SolverCounters::default()).unwrap();
            let amplitude = end.now.positions[IS].abs();
            assert!(
                amplitude < 1.2,
                "{stiffness} N/mm, {drag} N s/mm: {amplitude} mm"
            );
        }
    }

    #[test]
    fn inertia_is_added_until_the_asked_step_is_stable() {
        let mut counters = SolverCounters::default();
        let support = Support {
            stiffness: 1e5,
            drag: 60.0,
        };
        let end = released(support, MASS, 1e-3, &mut counters).unwrap();
        assert_eq!(counters.explicit_steps, 100);
        assert!(counters.added_inertia > 10.0, "{counters:?}");
        assert!(end.now.positions[IS].abs() < 1.2, "{end:?}");
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

    #[test]
    fn a_loaded_freedom_without_inertia_is_refused() {
        let support = Support {
            stiffness: 1.0,
            drag: 0.0,
        };
        let refused = released(support, 0.0, 0.0, &mut SolverCounters::default());
        assert_eq!(
            CycleError::from(refused.unwrap_err()).to_string(),
            "the explicit integrator needs inertia on every loaded freedom, and InferoSuperior has none; give it \
             some, or take the implicit integrator"
        );
    }

    #[test]
    fn a_motion_that_leaves_all_bounds_is_an_error() {
        let support = Support {
            stiffness: -1e4,
            drag: 0.0,
        };
        let lost = released(support, 1e-5, 0.0, &mut SolverCounters::default());
        let message = CycleError::from(lost.unwrap_err()).to_string();
        assert!(
            message.starts_with("explicit steps leave all bounds at "),
            "{message}"
        );
    }
}
