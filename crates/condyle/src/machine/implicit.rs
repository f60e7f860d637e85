//! One implicit step of time: second-order backward differences (BDF2), solved by Newton's iteration.

use super::{
    CycleError, Kinematics, Machine, MachineState, Simulator, WarmStart, balance::Balance,
    newton::NewtonIteration, simulator::Stepped,
};
use crate::spatial::RelativeMotion;

/// Iterations after which a step is given up and halved.
const MAX_ITERATIONS: usize = 12;

/// A step of backward differences: rate = `slope` q + `weight_now` q0 + `weight_before` q(-1).
struct BackwardStep<'a> {
    machine: &'a Machine,
    from: &'a MachineState,
    /// Phase at the end.
    phase: f64,
    step_s: f64,
    slope: f64,
    weight_now: f64,
    weight_before: f64,
}

impl<'a> BackwardStep<'a> {
    /// Creates a step of second order if the state includes the state before it, and of first order after a start.
    fn new(machine: &'a Machine, from: &'a MachineState, step: f64) -> Self {
        let step_s = step / machine.frequency_hz;
        let ratio = from.before.map_or(0.0, |(_, last_s)| step_s / last_s);
        Self {
            machine,
            from,
            phase: from.phase + step,
            step_s,
            slope: (1.0 + 2.0 * ratio) / (1.0 + ratio) / step_s,
            weight_now: -(1.0 + ratio) / step_s,
            weight_before: ratio * ratio / (1.0 + ratio) / step_s,
        }
    }

    /// Returns the rate at the end of a value that is `end` there, was `now` at the start and `before` a step
    /// earlier.
    fn rate(&self, end: f64, now: f64, before: Option<f64>) -> f64 {
        let earlier = before.map_or(0.0, |before| self.weight_before * before);
        self.slope * end + (self.weight_now * now + earlier)
    }

    /// Returns the motion at the end of the step, with the joints that are not driven at `positions`.
    fn kinematics(&self, mut positions: [f64; 6]) -> Kinematics {
        let (now, before) = (&self.from.now, self.from.before.as_ref());
        let before = before.map(|(before, _)| before);
        let mut rates = std::array::from_fn(|j| {
            let before = before.map(|before| before.positions[j]);
            self.rate(positions[j], now.positions[j], before)
        });
        // Between the two: the accelerations of driven joints follow from their exact rates.
        self.machine.drive(self.phase, &mut positions, &mut rates);
        let accelerations = std::array::from_fn(|j| {
            let before = before.map(|before| before.rates[j]);
            self.rate(rates[j], now.rates[j], before)
        });
        Kinematics {
            positions,
            rates,
            accelerations,
        }
    }

    /// Predicts the positions at the end from the cycle before; without a warm start, at constant acceleration.
    fn predicted(&self, warm_start: Option<&WarmStart>) -> [f64; 6] {
        let mut positions = warm_start.map_or_else(
            || self.from.extrapolated(self.step_s),
            |warm_start| warm_start.followed_from(&self.from.now, self.step_s),
        );
        self.machine
            .drive(self.phase, &mut positions, &mut [0.0; 6]);
        positions
    }

    fn ended(
        &self,
        now: Kinematics,
        motion: RelativeMotion,
        iteration: &NewtonIteration,
    ) -> Stepped {
        let state = MachineState {
            phase: self.phase,
            now,
            before: Some((self.from.now, self.step_s)),
        };
        Stepped {
            state,
            motion,
            warm_start: Some(WarmStart::new(&state, iteration.contraction_per_n)),
        }
    }
}

impl Simulator<'_> {
    /// Computes the state a `step` of the cycle later.
    ///
    /// BDF2 is stable however stiff the contact, damps what a step cannot resolve, and its error
    /// falls with the square of the step. `watch` receives the length of every residual, N.
    pub(super) fn implicit_step(
        &mut self,
        from: &MachineState,
        step: f64,
        warm_start: Option<&WarmStart>,
        watch: &mut dyn FnMut(f64),
    ) -> Result<Stepped, CycleError> {
        let step = BackwardStep::new(self.machine, from, step);
        let (levers, tolerance_n) = (self.machine.levers(), self.time.force_tolerance_n);
        let may_leave_n = self.time.trusts_prediction.then_some(tolerance_n);
        let start = step.predicted(warm_start);
        let mut iteration = NewtonIteration::new(levers, may_leave_n, start, warm_start);
        let loads = self.machine.loads_at(step.phase);
        for _ in 0..MAX_ITERATIONS {
            let kinematics = step.kinematics(iteration.positions);
            let balance = Balance::new(self.machine, self.chain, self.contact, kinematics);
            self.counters.contact_evaluations += 1;
            let residual = balance.residual(&loads);
            watch(levers.length_n(&residual));
            if levers.largest_n(&residual) <= tolerance_n {
                return Ok(step.ended(kinematics, balance.motion(), &iteration));
            }
            let mean_slip = balance.response.mean_slip;
            let tangent = || balance.tangent(step.slope, step.slope.powi(2));
            if !iteration.improve(&residual, mean_slip, tangent) {
                break;
            }
            self.counters.newton_iterations += 1;
            // If the prediction of the residual is good enough, the last evaluation of a step is skipped.
            if iteration.is_predicted_done() {
                let kinematics = step.kinematics(iteration.positions);
                let configuration = self.chain.at(&kinematics.positions);
                let motion = configuration.motion(&kinematics.rates);
                return Ok(step.ended(kinematics, motion, &iteration));
            }
        }
        Err(CycleError::NotConverged {
            percent: 100.0 * step.phase,
            readings: self.machine.mechanism.readings(&iteration.positions),
            residual_n: iteration.residual_n,
        })
    }

    /// Returns whether the estimated error of a step in the positions of the loaded joints is within the permitted
    /// one.
    pub(super) fn is_exact_enough(&self, from: &MachineState, to: &MachineState) -> bool {
        let at_most_mm = self.time.increment_error_mm;
        at_most_mm == 0.0 || step_error_mm(self.machine, from, to) <= at_most_mm
    }
}

/// The error of a step of backward differences over that of an extrapolation at constant
/// acceleration: 2/9 of h^3 and the third derivative against 1/2, since the rates and the
/// accelerations of the extrapolation are backward differences too.
const STEP_ERROR_PER_SURPRISE: f64 = 4.0 / 9.0;

/// Estimated error of a step in the positions of the loaded joints, mm; rotations on their lever.
fn step_error_mm(machine: &Machine, from: &MachineState, to: &MachineState) -> f64 {
    let levers = machine.levers();
    let step_s = to.before.map_or(0.0, |(_, step_s)| step_s);
    let extrapolated = from.extrapolated(step_s);
    // Both the step and the extrapolation miss the truth by a multiple of the same h^3 q''', so their
    // difference, which is known, is in constant proportion to the error of the step, which is not.
    let surprise_mm = |j: usize| (to.now.positions[j] - extrapolated[j]).abs() * levers.0[j];
    STEP_ERROR_PER_SURPRISE * machine.loaded().map(surprise_mm).fold(0.0, f64::max)
}
