//! Explicit steps of time by central differences: the balance of the implicit method with nothing to solve.

use std::f64::consts::PI;

use super::{
    CycleError, JointKind, Kinematics, Machine, MachineState, Simulator, balance::Balance,
    simulator::Stepped,
};
use crate::spatial::{Mat6, RelativeMotion};

/// Steps between two estimates of the stable step; each estimate costs one more contact evaluation.
const STEPS_PER_STABILITY: usize = 16;
/// Rates beyond which the motion is unstable, mm/s or rad/s.
const FASTEST: f64 = 1e6;
/// Positions of a loaded joint beyond which the bodies have parted, mm and rad: several times the size of a joint, and a
/// half turn.
const FARTHEST_MM: f64 = 200.0;
const FARTHEST_RAD: f64 = PI;
/// Part of the stable step that is taken: the load may grow before the next estimate.
const SAFETY: f64 = 0.8;
impl Simulator<'_> {
    /// Advances the machine to the phase `to` in equal steps, their length estimated again after every few of
    /// them. The contact accepts every step, and its last evaluation is at the positions returned.
    pub(super) fn explicit(
        &mut self,
        state: &MachineState,
        to: f64,
        least_step_s: f64,
    ) -> Result<Stepped, CycleError> {
        let mut loaded = self.machine.loaded();
        if let Some(j) = loaded.find(|&j| self.machine.joints[j].inertia <= 0.0) {
            let joint = self.machine.joints[j].description.long_name;
            return Err(CycleError::NoInertia { joint });
        }
        let (mut now, mut phase) = (state.now, state.phase);
        if self.energy.is_unpressed() {
            let held = self.balance(now).response.wrench.force.norm();
            self.energy.press(held);
        }
        loop {
            let still = Kinematics {
                rates: [0.0; 6],
                ..now
            };
            let quickness = Quickness::at_rest(self.machine, &self.balance(still));
            let (stable_step_s, inertia_factor) = quickness.stable_step(least_step_s);
            self.counters.added_inertia = (inertia_factor - 1.0).max(self.counters.added_inertia);
            // Equal steps that end exactly at `to`, none longer than the stable one.
            let rest_s = (to - phase) / self.machine.frequency_hz;
            let mut left = ((rest_s / stable_step_s).ceil() as usize).max(1);
            let step = (to - phase) / left as f64;
            for _ in 0..left.min(STEPS_PER_STABILITY) {
                left -= 1;
                phase = if left == 0 { to } else { phase + step };
                let (next, motion) = self.explicit_step(&now, phase, step, inertia_factor)?;
                // The steps are so short that the contact's own state may follow one step behind.
                let settled = self.contact.settle(&motion);
                let percent = 100.0 * phase;
                settled.map_err(|why| CycleError::NotBorne { percent, why })?;
                self.contact.accept(&motion);
                now = next;
                if left == 0 {
                    // The accelerations of explicit steps are no basis for backward differences.
                    let state = MachineState {
                        phase: to,
                        now,
                        before: None,
                    };
                    return Ok(Stepped {
                        state,
                        motion,
                        warm_start: None,
                    });
                }
            }
        }
    }

    /// One step of `step` of the cycle that ends at `phase`, and the counterface's motion there.
    ///
    /// v' = v + h/2 a, q1 = q + h v', a1 = a(q1, v' + h/2 a), v1 = v' + h/2 a1: leapfrog with the
    /// rates at whole steps; the contact receives rates of second order too.
    fn explicit_step(
        &mut self,
        now: &Kinematics,
        phase: f64,
        step: f64,
        inertia_factor: f64,
    ) -> Result<(Kinematics, RelativeMotion), CycleError> {
        let machine = self.machine;
        let half_s = step / machine.frequency_hz / 2.0;
        let mut next = Kinematics {
            accelerations: [0.0; 6],
            ..*now
        };
        for j in 0..6 {
            let change = half_s * now.accelerations[j];
            next.positions[j] += 2.0 * half_s * (now.rates[j] + change);
            next.rates[j] += 2.0 * change;
        }
        machine.drive(phase, &mut next.positions, &mut next.rates);
        let loads = machine.loads_at(phase);
        let pressing = machine
            .loaded()
            .filter(|&j| machine.joints[j].description.kind() == JointKind::Translation);
        pressing.for_each(|j| self.energy.press(loads[j].abs()));
        let balance = self.balance(next);
        let residual = balance.residual(&loads);
        for j in machine.loaded() {
            let inertia = inertia_factor * machine.joints[j].inertia;
            next.accelerations[j] = -residual[j] / inertia;
            next.rates[j] = now.rates[j] + half_s * (now.accelerations[j] + next.accelerations[j]);
        }
        let motion = balance.motion_at(&next.rates);
        let given_n_mm_per_s = balance.response.wrench.reaction().power(&motion.twist);
        self.energy.give(2.0 * half_s * given_n_mm_per_s);
        self.counters.explicit_steps += 1;
        self.check(phase, now, &next)?;
        Ok((next, motion))
    }

    /// Checks that a step from `now` to `next` stays within all bounds, and that no energy is made.
    fn check(&self, phase: f64, now: &Kinematics, next: &Kinematics) -> Result<(), CycleError> {
        let machine = self.machine;
        // NaN fails the comparison too.
        let is_bounded = |rate: &f64| rate.abs() <= FASTEST;
        let is_near = |j: usize| {
            let farthest = match machine.joints[j].description.kind() {
                JointKind::Rotation => FARTHEST_RAD,
                JointKind::Translation => FARTHEST_MM,
            };
            next.positions[j].abs() <= farthest
        };
        let how = if !(next.rates.iter().all(is_bounded) && machine.loaded().all(is_near)) {
            Some("leave all bounds")
        } else if self.energy.is_made() {
            Some("take more energy out of the contact than it can hold")
        } else {
            None
        };
        if let Some(how) = how {
            return Err(CycleError::Unstable {
                how,
                percent: 100.0 * phase,
                readings: machine.mechanism.readings(&now.positions),
                added_inertia: self.counters.added_inertia,
            });
        }
        Ok(())
    }

    fn balance(&mut self, kinematics: Kinematics) -> Balance<'_> {
        self.counters.contact_evaluations += 1;
        Balance::new(self.machine, self.chain, self.contact, kinematics)
    }
}

/// The speed of a machine's response, which limits the stable step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quickness {
    /// Highest eigenfrequency, or a bound of it, rad/s.
    frequency_per_s: f64,
    /// Highest rate of damping, 1/s.
    drag_per_s: f64,
}

impl Quickness {
    /// Creates the response at the present positions with every part at rest: there the regularised friction is
    /// steepest in the rate and limits the step.
    ///
    /// With M = diag of the inertias, and K and C the derivatives of the balance by positions and
    /// rates, the drag is the largest eigenvalue of M^-1/2 C M^-1/2, and the frequency the root of
    /// the norm of M^-1/2 K M^-1/2, which no eigenvalue exceeds.
    fn at_rest(machine: &Machine, balance: &Balance<'_>) -> Self {
        // 1/sqrt(M) on the diagonal of loaded rows; 0 on the others.
        // Scaled by the inertia on both sides, the matrices stay symmetric where K and C are.
        let mut diagonal = [0.0; 6];
        for j in machine.loaded() {
            diagonal[j] = machine.joints[j].inertia.sqrt().recip();
        }
        let scale = Mat6::from_diagonal(&diagonal.into());
        let stiffness = balance.tangent(0.0, 0.0);
        let damping = balance.tangent(1.0, 0.0) - stiffness;
        let drag = scale * (damping + damping.transpose()) * scale / 2.0;
        Self {
            frequency_per_s: (scale * stiffness * scale).norm().sqrt(),
            drag_per_s: drag.symmetric_eigenvalues().max(),
        }
    }

    /// Returns the stable step, s, and the factor on the inertia, above 1 where the step would be shorter than
    /// `least_step_s`.
    ///
    /// Central differences follow an oscillation up to h w = 2; with rates extrapolated from the two
    /// last half-steps they follow drag up to h c = 1. Both together are stable for h (c + w/2) <= 1.
    /// Inertia times f divides c by f and w by its root.
    fn stable_step(self, least_step_s: f64) -> (f64, f64) {
        let (drag, half) = (self.drag_per_s, self.frequency_per_s / 2.0);
        let step_s = SAFETY / (drag + half);
        if step_s >= least_step_s {
            return (step_s, 1.0);
        }
        let linear = least_step_s * half;
        let root = (linear + (linear * linear + 4.0 * SAFETY * least_step_s * drag).sqrt())
            / (2.0 * SAFETY);
        (least_step_s, root * root)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Vec3,
        contact::{ContactModel, ContactResult, MAX_REGIONS, Response, Tangent},
        machine::{
            Chain, Drive, SolverCounters, TimeSettings, Waveform,
            knee::{IS, KNEE},
        },
        spatial::{Mat6, Wrench, WrenchByTwist},
    };

    const MASS: f64 = 0.005;

    /// A spring and a dashpot under the counterface, along y.
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

    impl ContactModel for Support {
        fn node_count(&self) -> usize {
            0
        }

        fn respond(&mut self, motion: &RelativeMotion) -> Response {
            let (height, speed) = (motion.pose.translation.y, motion.twist.linear.y);
            let force = Vec3::y() * (self.stiffness * height + self.drag * speed);
            let wrench = Wrench::new(Vec3::zeros(), force);
            let mean_slip = [Vec3::zeros(); MAX_REGIONS];
            Response { wrench, mean_slip }
        }

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

        fn accept(&mut self, _: &RelativeMotion) {
            self.accepted += 1;
        }

        fn evaluate(&mut self, _: &RelativeMotion) -> ContactResult {
            ContactResult::default()
        }
    }

    /// Returns a machine that moves IS alone, without load.
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

    /// Returns the state after 0.1 s from 1 mm above rest.
    fn released(
        support: Support,
        inertia: f64,
        least_step_s: f64,
        counters: &mut SolverCounters,
    ) -> Result<MachineState, CycleError> {
        let machine = machine(inertia);
        let mut start = MachineState::at_rest(&machine, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        start.now.accelerations[IS.place()] = -support.stiffness / inertia;
        let mut contact = support;
        let chain = Chain::new(&machine, Vec3::zeros(), (0.0, 0.0));
        let time = TimeSettings::default();
        let mut simulator = Simulator::new(&machine, &chain, &mut contact, &time);
        let end = simulator.explicit(&start, 0.1, least_step_s)?;
        *counters = simulator.counters;
        assert_eq!(
            contact.accepted, counters.explicit_steps,
            "every step is accepted"
        );
        let height_mm = end.motion.pose.translation.y;
        assert_eq!(height_mm, end.state.now.positions[IS.place()]);
        Ok(end.state)
    }

    #[test]
    fn verify_damped_oscillation_to_second_order() {
        let (stiffness, drag) = (50.0, 0.2);
        let machine = machine(MASS);
        let after = |steps: u32| {
            let mut now = MachineState::at_rest(&machine, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]).now;
            now.accelerations[IS.place()] = -stiffness / MASS;
            let chain = Chain::new(&machine, Vec3::zeros(), (0.0, 0.0));
            let (mut contact, time) = (support(stiffness, drag), TimeSettings::default());
            let mut simulator = Simulator::new(&machine, &chain, &mut contact, &time);
            for _ in 0..steps {
                let step = 0.1 / f64::from(steps);
                now = simulator.explicit_step(&now, 0.0, step, 1.0).unwrap().0;
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
    fn a_counterface_that_flies_off_ends_the_run_where_it_leaves() {
        let mut machine = machine(MASS);
        machine.joint_mut(IS).drive = Drive::Loaded(Waveform::constant(1000.0));
        let mut start = MachineState::at_rest(&machine, [0.0; 6]);
        start.now.accelerations[IS.place()] = 1000.0 / MASS;
        let mut contact = support(1e-3, 0.0);
        let chain = Chain::new(&machine, Vec3::zeros(), (0.0, 0.0));
        let time = TimeSettings::default();
        let mut simulator = Simulator::new(&machine, &chain, &mut contact, &time);
        // It is 1000 mm away after 0.1 s, at a rate far below the limit.
        let end = simulator.explicit(&start, 0.1, 0.0);
        assert!(matches!(end, Err(CycleError::Unstable { .. })));
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
            refused.unwrap_err().to_string(),
            "the explicit integrator needs inertia on every loaded freedom, and InferoSuperior has none; give it \
             some, or take the implicit integrator"
        );
    }

    #[test]
    fn a_contact_that_gives_more_energy_than_it_holds_ends_the_run_while_all_is_near() {
        // Its drag drives the motion: from 1 mm it would grow to 7 mm.
        let counters = &mut SolverCounters::default();
        let driven = released(support(50.0, -0.2), MASS, 0.0, counters);
        let message = driven.unwrap_err().to_string();
        assert!(
            message.starts_with(
                "explicit steps take more energy out of the contact than it can hold at "
            ),
            "{message}"
        );
        assert!(message.contains("IS "), "{message}");
    }

    #[test]
    fn added_inertia_makes_the_asked_step_just_stable() {
        let quickness = Quickness {
            frequency_per_s: 4000.0,
            drag_per_s: 3e4,
        };
        let (_, factor) = quickness.stable_step(1e-3);
        let heavier = Quickness {
            frequency_per_s: 4000.0 / factor.sqrt(),
            drag_per_s: 3e4 / factor,
        };
        assert!((heavier.stable_step(0.0).0 / 1e-3 - 1.0).abs() < 1e-12);
    }
}
