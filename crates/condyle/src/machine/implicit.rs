//! One implicit step of time: second-order backward differences (BDF2), solved by Newton's iteration.

use super::{
    CycleError, Kinematics, Machine, MachineState, Simulator, WarmStart,
    assembly::Levers,
    balance::{Balance, correction, move_by},
    simulator::Stepped,
};
use crate::{
    Vec3,
    contact::MAX_REGIONS,
    spatial::{Mat6, RelativeMotion, Vec6},
};

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
        // A ratio of 0 turns the formula into that of first order.
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
    /// falls with the square of the step.
    pub(super) fn implicit_step(
        &mut self,
        from: &MachineState,
        step: f64,
        warm_start: Option<&WarmStart>,
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
            self.residuals_n.push(levers.length_n(&residual));
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
            if may_leave_n.is_some_and(|may_leave_n| iteration.predicted_n <= may_leave_n) {
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
        if at_most_mm == 0.0 {
            return true;
        }
        let levers = self.machine.levers();
        let step_s = to.before.map_or(0.0, |(_, step_s)| step_s);
        let extrapolated = from.extrapolated(step_s);
        // Both the step and the extrapolation miss the truth by a multiple of the same h^3 q''', so their
        // difference, which is known, is in constant proportion to the error of the step, which is not.
        let surprise_mm = |j: usize| (to.now.positions[j] - extrapolated[j]).abs() * levers.0[j];
        let surprises_mm = self.machine.loaded().map(surprise_mm);
        STEP_ERROR_PER_SURPRISE * surprises_mm.fold(0.0, f64::max) <= at_most_mm
    }
}

/// The error of a step of backward differences over that of an extrapolation at constant
/// acceleration: 2/9 of h^3 and the third derivative against 1/2, since the rates and the
/// accelerations of the extrapolation are backward differences too.
const STEP_ERROR_PER_SURPRISE: f64 = 4.0 / 9.0;

/// Smallest part of a correction that backtracking keeps.
const MIN_PART_OF_CORRECTION: f64 = 0.1;
/// Backtracking to a correction shorter than this has failed, mm.
const SHORTEST_CORRECTION_MM: f64 = 1e-9;
/// Safety factor on the contraction of a cycle before.
const CAUTION: f64 = 2.0;
/// Part of a residual beyond which the correction is not yet in the quadratic range.
const CONVERGING: f64 = 0.1;
/// Safety factor on the contraction of a correction by the tangent of the one before.
const CHORD_CAUTION: f64 = 4.0;
/// Longest correction, mm; on the lever, rad.
const LONGEST_CORRECTION_MM: f64 = 1.0;

/// Newton's iteration with a line search.
struct NewtonIteration {
    levers: Levers,
    positions: [f64; 6],
    /// Length of the residual from which the last correction was computed, N.
    residual_n: f64,
    /// The part of the last correction that was taken.
    taken: Vec6,
    /// Mean slip of the regions where the last correction was computed, mm/s.
    mean_slip: [Vec3; MAX_REGIONS],
    is_whole: bool,
    /// Largest predicted residual, N, at which the iteration may end without evaluating it; none if every correction
    /// requires its own tangent and every residual is evaluated.
    may_leave_n: Option<f64>,
    /// Predicted length of the residual at the present positions, N; infinite if there is no prediction.
    predicted_n: f64,
    /// The contraction: residual after a whole correction near the solution over the square
    /// of the residual before it, as observed last, 1/N.
    contraction_per_n: f64,
    caution: f64,
    tangent: Option<Mat6>,
}

impl NewtonIteration {
    /// Creates an iteration from `positions`, with the contraction of a cycle before if there is a warm start.
    fn new(
        levers: Levers,
        may_leave_n: Option<f64>,
        positions: [f64; 6],
        warm_start: Option<&WarmStart>,
    ) -> Self {
        Self {
            levers,
            may_leave_n,
            positions,
            residual_n: f64::INFINITY,
            taken: Vec6::zeros(),
            mean_slip: [Vec3::zeros(); MAX_REGIONS],
            is_whole: false,
            predicted_n: f64::INFINITY,
            contraction_per_n: warm_start.map_or(f64::INFINITY, |last| last.contraction_per_n),
            caution: CAUTION,
            tangent: None,
        }
    }

    /// Moves to better positions; false if none are found.
    ///
    /// A correction that has made the residual longer is backtracked; otherwise the next one follows. `tangent` is
    /// evaluated only if the tangent of the last correction is not good enough.
    fn improve(
        &mut self,
        residual: &Vec6,
        mean_slip: [Vec3; MAX_REGIONS],
        tangent: impl FnOnce() -> Mat6,
    ) -> bool {
        let residual_n = self.levers.length_n(residual);
        if residual_n > self.residual_n {
            return self.backtrack(residual_n, &mean_slip);
        }
        self.mean_slip = mean_slip;
        self.observe_contraction(residual_n);
        let newton_leaves_n = self.caution * self.contraction_per_n * residual_n * residual_n;
        let (tangent, leaves_n) = self
            .chord(residual_n)
            .unwrap_or_else(|| (tangent(), newton_leaves_n));
        let solved = correction(&tangent, residual);
        let is_finite = |motions: &Vec6| motions.iter().all(|motion| motion.is_finite());
        let Some(correction) = solved.filter(is_finite) else {
            return false;
        };
        let part = self.levers.part_within(&correction, LONGEST_CORRECTION_MM);
        self.is_whole = part == 1.0;
        // The contraction is that of whole corrections only.
        self.predicted_n = if self.is_whole {
            leaves_n
        } else {
            f64::INFINITY
        };
        self.residual_n = residual_n;
        self.tangent = Some(tangent);
        self.taken = correction * part;
        move_by(&mut self.positions, &self.taken);
        true
    }

    /// Takes back a part of the last correction, after which the residual is longer; false if too little of it
    /// would remain.
    ///
    /// In most cases friction has reversed, and the iteration continues best from where the slip is zero: there
    /// friction is stiffest, and a correction from there does not overshoot. Otherwise the best part is the minimum
    /// of the parabola through both lengths and the slope that Newton's method implies.
    fn backtrack(&mut self, residual_n: f64, mean_slip: &[Vec3; MAX_REGIONS]) -> bool {
        if let Some(part) = standstill(&self.mean_slip, mean_slip) {
            self.keep(part);
            // Any residual counts as progress from there.
            self.residual_n = f64::INFINITY;
            return true;
        }
        let (before, after) = (self.residual_n.powi(2), residual_n.powi(2));
        self.keep((before / (before + after)).max(MIN_PART_OF_CORRECTION));
        self.levers.longest_mm(&self.taken) > SHORTEST_CORRECTION_MM
    }

    fn keep(&mut self, part: f64) {
        move_by(&mut self.positions, &(self.taken * (part - 1.0)));
        self.taken *= part;
        self.is_whole = false;
    }

    /// Updates the contraction from the residual after the last correction, if it was whole.
    ///
    /// Near the solution a correction leaves c r^2 of a residual r, so one that reduced r0 to r1 gives c = r1/r0^2.
    /// Before the first correction the c of a cycle ago applies, with a safety factor.
    fn observe_contraction(&mut self, residual_n: f64) {
        if !self.is_whole {
            return;
        }
        let left = residual_n / self.residual_n;
        self.contraction_per_n = if left <= CONVERGING {
            left / self.residual_n
        } else {
            f64::INFINITY
        };
        // The contraction of this step is known now.
        self.caution = 1.0;
    }

    /// Returns the tangent of the last correction, and the predicted residual after a whole correction by it, N; none
    /// if that exceeds the permitted one.
    ///
    /// A tangent is the most expensive part of a correction, and the last correction need not be as good: the chord
    /// method reduces the residual by about the same factor as the correction before.
    fn chord(&self, residual_n: f64) -> Option<(Mat6, f64)> {
        let leaves_n = CHORD_CAUTION * residual_n / self.residual_n * residual_n;
        let serves = self.is_whole && leaves_n <= self.may_leave_n?;
        Some((self.tangent.filter(|_| serves)?, leaves_n))
    }
}

/// Returns the part of a correction after which the first of the regions stands still, whose mean slip was `before`
/// and is `after`; none if no slip reverses.
fn standstill(before: &[Vec3; MAX_REGIONS], after: &[Vec3; MAX_REGIONS]) -> Option<f64> {
    let regions = before.iter().zip(after);
    let turning = regions.filter(|(before, after)| before.dot(after) < 0.0);
    let part = |(before, after): (&Vec3, &Vec3)| {
        let change = after - before;
        -before.dot(&change) / change.norm_squared()
    };
    turning.map(part).reduce(f64::min)
}
