//! One implicit step of time: second-order backward differences (BDF2), solved by Newton's iteration.

use super::{
    Chain, Kinematics, Machine, MachineState, SolverCounters, WarmStart,
    balance::{Balance, StepSlopes},
    newton::NewtonIteration,
};
use crate::{contact::ContactModel, spatial::RelativeMotion};

/// Iterations after which a step is given up, and tried in halves.
const MAX_ITERATIONS: usize = 12;

/// Why a step was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NotConverged {
    pub phase: f64,
    pub positions: [f64; 6],
    pub residual_n: f64,
}

/// Where a step has ended.
pub(super) struct Stepped {
    pub state: MachineState,
    /// The femur's motion past the insert there.
    pub motion: RelativeMotion,
    /// How the step was solved, for the same step a cycle later.
    pub warm_start: WarmStart,
}

/// Everything one implicit step needs beside the state.
pub(super) struct Implicit<'a> {
    pub machine: &'a Machine,
    pub chain: &'a Chain,
    pub contact: &'a mut dyn ContactModel,
    pub force_tolerance_n: f64,
    /// Whether a predicted residual counts as if it were computed.
    pub trusts_prediction: bool,
    pub counters: &'a mut SolverCounters,
}

/// A step that is being solved.
struct TimeStep<'a> {
    machine: &'a Machine,
    from: &'a MachineState,
    phase: f64,
    step_s: f64,
    differences: BackwardDifferences,
}

impl TimeStep<'_> {
    fn kinematics(&self, iteration: &NewtonIteration) -> Kinematics {
        let positions = iteration.positions();
        self.differences
            .kinematics(self.machine, self.from, positions, self.phase)
    }

    /// Where the joints will be, as a cycle before; without a warm start, if accelerations last.
    /// Driven ones, where they are driven.
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
            warm_start: WarmStart::new(&state, iteration.contraction_per_n()),
        }
    }
}

impl Implicit<'_> {
    /// The state a `step` of the cycle later.
    ///
    /// BDF2 is stable however stiff the contact, damps what a step cannot resolve, and its error
    /// falls with the square of the step. `watch` is told the length of every residual, N.
    pub fn step(
        &mut self,
        from: &MachineState,
        step: f64,
        warm_start: Option<&WarmStart>,
        watch: &mut dyn FnMut(f64),
    ) -> Result<Stepped, NotConverged> {
        let step_s = step / self.machine.frequency_hz;
        let step = TimeStep {
            machine: self.machine,
            from,
            phase: from.phase + step,
            step_s,
            differences: BackwardDifferences::from(from, step_s),
        };
        let levers = self.machine.levers();
        let may_leave_n = self.trusts_prediction.then_some(self.force_tolerance_n);
        let start = step.predicted(warm_start);
        let mut iteration = NewtonIteration::new(levers, may_leave_n, start, warm_start);
        let loads = self.machine.loads_at(step.phase);
        for _ in 0..MAX_ITERATIONS {
            let kinematics = step.kinematics(&iteration);
            let balance = Balance::new(self.machine, self.chain, self.contact, kinematics);
            self.counters.contact_evaluations += 1;
            let residual = balance.residual(&loads);
            watch(residual.length_n(&levers));
            if residual.largest_n(&levers) <= self.force_tolerance_n {
                return Ok(step.ended(kinematics, balance.motion(), &iteration));
            }
            let mean_slip = balance.response().mean_slip;
            let tangent = || balance.tangent(step.differences.slopes());
            if !iteration.improve(&residual, mean_slip, tangent) {
                break;
            }
            self.counters.newton_iterations += 1;
            if iteration.is_predicted_done() {
                let kinematics = step.kinematics(&iteration);
                let configuration = self.chain.at(&kinematics.positions);
                let motion = configuration.motion(&kinematics.rates);
                return Ok(step.ended(kinematics, motion, &iteration));
            }
        }
        Err(NotConverged {
            phase: step.phase,
            positions: iteration.positions(),
            residual_n: iteration.residual_n(),
        })
    }
}

/// The weights of the backward differences: rate = slope q + weights on what was before.
pub(super) struct BackwardDifferences {
    slope: f64,
    now: f64,
    before: f64,
}

impl BackwardDifferences {
    /// Those of a step of `step_s` from a state; second order where the state knows the one before it,
    /// first order after a start.
    pub fn from(state: &MachineState, step_s: f64) -> Self {
        let ratio = state.before.map_or(0.0, |(_, last_s)| step_s / last_s);
        Self {
            slope: (1.0 + 2.0 * ratio) / (1.0 + ratio) / step_s,
            now: -(1.0 + ratio) / step_s,
            before: ratio * ratio / (1.0 + ratio) / step_s,
        }
    }

    /// How rates and accelerations at the end of the step follow the positions there.
    pub fn slopes(&self) -> StepSlopes {
        StepSlopes {
            rate: self.slope,
            acceleration: self.slope.powi(2),
        }
    }

    /// Rate of a value at the end of the step from what it is there, was at the start and was before.
    fn rate(&self, end: f64, now: f64, before: Option<f64>) -> f64 {
        self.slope * end + (self.now * now + before.map_or(0.0, |before| self.before * before))
    }

    /// Joints at the end of the step, at `phase`, where they are at `positions` unless they are driven.
    pub fn kinematics(
        &self,
        machine: &Machine,
        state: &MachineState,
        mut positions: [f64; 6],
        phase: f64,
    ) -> Kinematics {
        let (now, before) = (&state.now, state.before.as_ref().map(|(before, _)| before));
        let mut rates = std::array::from_fn(|j| {
            let before = before.map(|before| before.positions[j]);
            self.rate(positions[j], now.positions[j], before)
        });
        machine.drive(phase, &mut positions, &mut rates);
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
}

/// What the error of a step of backward differences is of that of an extrapolation with lasting
/// accelerations: 2/9 of h^3 and the third derivative against 1/2, since the rates and the
/// accelerations that the extrapolation goes by are backward differences too.
const STEP_ERROR_PER_SURPRISE: f64 = 4.0 / 9.0;

/// Estimated error that a step makes in the positions of the loaded joints, mm; rotations on their
/// lever.
pub(super) fn step_error_mm(machine: &Machine, from: &MachineState, to: &MachineState) -> f64 {
    let levers = machine.levers();
    let step_s = to.before.map_or(0.0, |(_, step_s)| step_s);
    let extrapolated = from.extrapolated(step_s);
    // Both the step and the extrapolation miss the truth by a multiple of the same h^3 q''', so their
    // difference, which is known, is in constant proportion to the error of the step, which is not.
    let surprise_mm = |j: usize| (to.now.positions[j] - extrapolated[j]).abs() * levers.of_joint(j);
    STEP_ERROR_PER_SURPRISE * machine.loaded().map(surprise_mm).fold(0.0, f64::max)
}
