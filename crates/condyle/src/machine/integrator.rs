//! One step of time: the second-order backward differences, solved by Newton's method.

use super::{
    Chain, Drive, FREEDOMS, Freedom, Machine, WarmStart,
    balance::{Balance, Kinematics, StepSlopes},
    joint_numbers::{Mat6, Vec6},
};
use crate::{Vec3, contact::ContactModel};
use serde::{Deserialize, Serialize};

/// Lever on which a moment out of balance counts as a force, mm.
const MOMENT_LEVER_MM: f64 = 10.0;
/// Iterations after which a step is given up, and tried in halves.
const MOST_ITERATIONS: usize = 12;
/// A correction taken back keeps at least this part.
const LEAST_PART_OF_CORRECTION: f64 = 0.1;
/// A correction taken back to less than this has found no better place, mm.
const SHORTEST_CORRECTION_MM: f64 = 1e-9;
/// What a correction leaves of a residual is foreseen to be up to this many times what it left a
/// cycle before.
const CAUTION: f64 = 2.0;
/// A whole correction that leaves more of the residual is none of the last, quadratic ones.
const CONVERGING: f64 = 0.1;
/// Farthest that one iteration may move, mm; on the lever, rad.
const LONGEST_CORRECTION_MM: f64 = 1.0;

/// The machine at an instant, with what a two-step method remembers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineState {
    /// Instant, in cycles.
    pub phase: f64,
    /// Positions and rates now.
    pub now: Kinematics,
    /// Positions and rates one step ago, and how long that step was in s; none after a start.
    pub before: Option<(Kinematics, f64)>,
}

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolverCounters {
    /// Newton iterations: corrections of the positions.
    pub newton_iterations: u64,
    /// Contact evaluations, each with its tangent but for explicit steps.
    pub contact_evaluations: u64,
    /// Steps given up and tried in halves.
    pub halvings: u64,
    /// Explicit steps.
    pub explicit_steps: u64,
    /// Most inertia that explicit steps added, as a part of the machine's own.
    pub added_inertia: f64,
}

/// Why a step was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NotConverged {
    pub phase: f64,
    pub positions: [f64; 6],
    pub residual_n: f64,
}

/// Newton's method with a line search, on its way.
struct Attempt {
    positions: [f64; 6],
    /// Length of the residual where the last full correction was computed, N.
    residual_n: f64,
    /// The part of the last correction that was taken.
    taken: Vec6,
    /// How the two sides slid where the last full correction was computed, mm/s.
    slips: [Vec3; 2],
    /// Whether that was all of it.
    is_whole: bool,
    /// Length of the residual where the attempt is now, as far as it can be foreseen, N.
    foreseen_n: f64,
    /// What a whole correction left of a residual near the solution, over its square, when that was
    /// seen last, 1/N.
    contraction_per_n: f64,
    /// How many times that it is foreseen to leave.
    caution: f64,
}

impl Attempt {
    fn new(positions: [f64; 6], warm_start: Option<&WarmStart>) -> Self {
        Self {
            positions,
            contraction_per_n: warm_start.map_or(f64::INFINITY, |last| last.contraction_per_n),
            caution: CAUTION,
            residual_n: f64::INFINITY,
            taken: Vec6::zeros(),
            slips: [Vec3::zeros(); 2],
            is_whole: false,
            foreseen_n: f64::INFINITY,
        }
    }

    /// Moves to better positions; false where there are none.
    ///
    /// A correction that has made the residual longer is taken back in part. Mostly friction has
    /// turned round, and then the place to go on from is where the slip stands still: there friction
    /// resists most, and a correction from there does not fly past. Otherwise it is the minimum of
    /// the parabola through both lengths and the slope that Newton's method implies.
    fn improve(
        &mut self,
        residual: &Vec6,
        slips: [Vec3; 2],
        tangent: impl FnOnce() -> Mat6,
    ) -> bool {
        let residual_n = length_n(residual);
        if residual_n > self.residual_n {
            if let Some(keep) = standstill(&self.slips, &slips) {
                self.take_back(keep);
                self.residual_n = f64::INFINITY;
                return true;
            }
            let (before, after) = (self.residual_n.powi(2), residual_n.powi(2));
            self.take_back((before / (before + after)).max(LEAST_PART_OF_CORRECTION));
            return longest_mm(&self.taken) > SHORTEST_CORRECTION_MM;
        }
        self.slips = slips;
        let solved = tangent().lu().solve(&-residual);
        let Some(correction) = solved.filter(|c| c.iter().all(|x| x.is_finite())) else {
            return false;
        };
        let part = (LONGEST_CORRECTION_MM / longest_mm(&correction)).min(1.0);
        self.foresee(residual_n, part == 1.0);
        self.taken = correction * part;
        self.step(self.taken);
        true
    }

    /// Keeps a part of the last correction only.
    fn take_back(&mut self, keep: f64) {
        self.step(self.taken * (keep - 1.0));
        self.taken *= keep;
        self.is_whole = false;
    }

    /// Foresees the residual after a correction from one of `residual_n`.
    ///
    /// Near the solution each whole correction leaves c r^2 of a residual r. One that shortened r0
    /// to r1 says that c = r1/r0^2; before there is one, a cycle ago says it.
    fn foresee(&mut self, residual_n: f64, is_whole: bool) {
        let left = residual_n / self.residual_n;
        if self.is_whole {
            self.contraction_per_n = if left <= CONVERGING {
                left / self.residual_n
            } else {
                f64::INFINITY
            };
            self.caution = 1.0;
        }
        self.foreseen_n = if is_whole {
            self.caution * self.contraction_per_n * residual_n * residual_n
        } else {
            f64::INFINITY
        };
        self.residual_n = residual_n;
        self.is_whole = is_whole;
    }

    fn step(&mut self, motion: Vec6) {
        self.positions
            .iter_mut()
            .zip(&motion)
            .for_each(|(q, c)| *q += c);
    }
}

/// The part of a correction after which the first of two sides, slipping as `before` and then as
/// `after`, stands still; none if none turns round.
fn standstill(before: &[Vec3; 2], after: &[Vec3; 2]) -> Option<f64> {
    let sides = before.iter().zip(after);
    let turning = sides.filter(|(before, after)| before.dot(after) < 0.0);
    let part = |(before, after): (&Vec3, &Vec3)| {
        let change = after - before;
        -before.dot(&change) / change.norm_squared()
    };
    turning.map(part).reduce(f64::min)
}

/// The weights of the backward differences: rate = slope q + sum of the past.
struct Differences {
    slope: f64,
    now: f64,
    before: f64,
}

impl Differences {
    /// Second order with a step `ratio` times as long as the last; first order with ratio 0.
    fn new(step_s: f64, ratio: f64) -> Self {
        Self {
            slope: (1.0 + 2.0 * ratio) / (1.0 + ratio) / step_s,
            now: -(1.0 + ratio) / step_s,
            before: ratio * ratio / (1.0 + ratio) / step_s,
        }
    }
}

/// Everything one step needs beside the state.
pub(super) struct Integrator<'a> {
    pub machine: &'a Machine,
    pub chain: &'a Chain,
    pub contact: &'a mut dyn ContactModel,
    pub force_tolerance_n: f64,
    /// Whether a residual that is foreseen counts as if it were computed.
    pub foresees: bool,
    pub counters: &'a mut SolverCounters,
}

impl Integrator<'_> {
    /// The state a `step` of the cycle later.
    ///
    /// BDF2 is stable however stiff the contact, damps what a step cannot resolve, and its error
    /// falls with the square of the step. `watch` is told the length of every residual, N.
    pub fn step(
        &mut self,
        state: &MachineState,
        step: f64,
        warm_start: Option<&WarmStart>,
        watch: &mut dyn FnMut(f64),
    ) -> Result<(MachineState, WarmStart), NotConverged> {
        let phase = state.phase + step;
        let step_s = step / self.machine.frequency_hz;
        let ratio = state.before.map_or(0.0, |(_, last_s)| step_s / last_s);
        let differences = Differences::new(step_s, ratio);
        let slopes = StepSlopes {
            rate: differences.slope,
            acceleration: differences.slope.powi(2),
        };
        let loads = loads_at(self.machine, phase);
        let landed = |now: Kinematics, attempt: &Attempt| {
            let state = MachineState {
                phase,
                now,
                before: Some((state.now, step_s)),
            };
            (state, WarmStart::new(&state, attempt.contraction_per_n))
        };
        let predicted = self.predicted(state, step_s, phase, warm_start);
        let mut attempt = Attempt::new(predicted, warm_start);
        for _ in 0..MOST_ITERATIONS {
            let kinematics = self.kinematics(state, &differences, attempt.positions, phase);
            let balance = Balance::new(self.machine, self.chain, self.contact, kinematics);
            self.counters.contact_evaluations += 1;
            let residual = balance.residual(&loads);
            watch(length_n(&residual));
            if out_of_balance_n(&residual) <= self.force_tolerance_n {
                return Ok(landed(kinematics, &attempt));
            }
            let slips = balance.response().mean_slip;
            if !attempt.improve(&residual, slips, || balance.tangent(slopes)) {
                break;
            }
            self.counters.newton_iterations += 1;
            if self.foresees && attempt.foreseen_n <= self.force_tolerance_n {
                let kinematics = self.kinematics(state, &differences, attempt.positions, phase);
                return Ok(landed(kinematics, &attempt));
            }
        }
        Err(NotConverged {
            phase,
            positions: attempt.positions,
            residual_n: attempt.residual_n,
        })
    }

    /// Where the freedoms will be, as a cycle before; without a warm_start, if accelerations last.
    /// Driven ones, where they are driven.
    fn predicted(
        &self,
        state: &MachineState,
        step_s: f64,
        phase: f64,
        warm_start: Option<&WarmStart>,
    ) -> [f64; 6] {
        let mut positions = match warm_start {
            Some(warm_start) => warm_start.followed_from(&state.now, step_s),
            None => lasting(state, step_s),
        };
        drive(self.machine, phase, &mut positions, &mut [0.0; 6]);
        positions
    }

    fn kinematics(
        &self,
        state: &MachineState,
        differences: &Differences,
        mut positions: [f64; 6],
        phase: f64,
    ) -> Kinematics {
        let past = |now: &[f64; 6], before: Option<&[f64; 6]>, j: usize| {
            differences.now * now[j] + before.map_or(0.0, |before| differences.before * before[j])
        };
        let before = state.before.as_ref().map(|(kinematics, _)| kinematics);
        let (mut rates, mut accelerations) = ([0.0; 6], [0.0; 6]);
        for j in 0..6 {
            rates[j] = differences.slope * positions[j]
                + past(&state.now.positions, before.map(|b| &b.positions), j);
        }
        drive(self.machine, phase, &mut positions, &mut rates);
        for j in 0..6 {
            accelerations[j] =
                differences.slope * rates[j] + past(&state.now.rates, before.map(|b| &b.rates), j);
        }
        Kinematics {
            positions,
            rates,
            accelerations,
        }
    }
}

/// Where the freedoms go if accelerations last; after a start, where there are none yet, if rates do.
fn lasting(state: &MachineState, step_s: f64) -> [f64; 6] {
    let now = &state.now;
    let half_s2 = match state.before {
        Some(_) => 0.5 * step_s * step_s,
        None => 0.0,
    };
    std::array::from_fn(|j| {
        now.positions[j] + step_s * now.rates[j] + half_s2 * now.accelerations[j]
    })
}

/// What the error of a step of backward differences is of that of a prediction with lasting
/// accelerations: 2/9 of h^3 and the third derivative against 1/2, since the rates and the
/// accelerations that the prediction goes by are backward differences too.
const STEP_ERROR_PER_PREDICTION: f64 = 4.0 / 9.0;

/// Estimated error that a step makes in the positions of the loaded freedoms, mm; rotations on
/// their lever.
pub(super) fn step_error_mm(machine: &Machine, from: &MachineState, to: &MachineState) -> f64 {
    let step_s = to.before.map_or(0.0, |(_, step_s)| step_s);
    let predicted = lasting(from, step_s);
    let surprise_mm = |freedom: &Freedom| {
        let j = *freedom as usize;
        (to.now.positions[j] - predicted[j]).abs() * lever_mm(j)
    };
    let loaded = |freedom: &&Freedom| matches!(machine.row(**freedom).drive, Drive::Loaded(_));
    let surprises = FREEDOMS.iter().filter(loaded).map(surprise_mm);
    STEP_ERROR_PER_PREDICTION * surprises.fold(0.0, f64::max)
}

/// Sets positions and rates of the freedoms that are locked or prescribed.
pub(super) fn drive(machine: &Machine, phase: f64, positions: &mut [f64; 6], rates: &mut [f64; 6]) {
    for freedom in FREEDOMS {
        let j = freedom as usize;
        match &machine.row(freedom).drive {
            Drive::Locked(at) => (positions[j], rates[j]) = (*at, 0.0),
            Drive::Prescribed(waveform) => {
                let (value, slope) = waveform.at(phase);
                (positions[j], rates[j]) = (value, slope * machine.frequency_hz);
            }
            Drive::Loaded(_) => {}
        }
    }
}

/// Load on every freedom, N or N mm.
pub(super) fn loads_at(machine: &Machine, phase: f64) -> [f64; 6] {
    FREEDOMS.map(|freedom| match &machine.row(freedom).drive {
        Drive::Loaded(waveform) => waveform.at(phase).0,
        Drive::Locked(_) | Drive::Prescribed(_) => 0.0,
    })
}

/// Lever of a freedom, mm: what turns its moments into forces and its rotations into motions.
fn lever_mm(j: usize) -> f64 {
    if FREEDOMS[j].is_rotation() {
        MOMENT_LEVER_MM
    } else {
        1.0
    }
}

/// Largest force out of balance, N, moments on their lever.
pub(super) fn out_of_balance_n(residual: &Vec6) -> f64 {
    let force = |j: usize| residual[j].abs() / lever_mm(j);
    (0..6).map(force).fold(0.0, f64::max)
}

/// Length of a residual, N, moments on their lever.
fn length_n(residual: &Vec6) -> f64 {
    let force = |j: usize| residual[j] / lever_mm(j);
    (0..6).map(|j| force(j).powi(2)).sum::<f64>().sqrt()
}

/// Longest motion of a correction, mm, rotations on their lever.
pub(super) fn longest_mm(correction: &Vec6) -> f64 {
    let motion = |j: usize| correction[j].abs() * lever_mm(j);
    (0..6).map(motion).fold(0.0, f64::max)
}
