//! Solves gait cycles increment by increment until the motion is periodic.

use std::ops::{ControlFlow, Range};

use super::{
    Chain, Cycle, CycleError, CycleRow, Integration, Machine, MachineState, SolverCounters,
    TimeSettings, WarmStart, balance::Balance, contact_energy::ContactEnergy,
};
use crate::{
    contact::{ContactModel, CycleHistory, Moment, Record, Settled, TouchedNode},
    spatial::RelativeMotion,
};

const MAX_HALVINGS: u32 = 8;
/// Limit of the solutions of a step for a contact whose own state depends on the load. Each solution reduces the error
/// of that state to about a third.
const MAX_TURNS: u32 = 20;

pub(super) struct Stepped {
    pub state: MachineState,
    /// The counterface's motion past the insert.
    pub motion: RelativeMotion,
    /// The solution, if it was one implicit step.
    pub warm_start: Option<WarmStart>,
}

#[derive(Clone)]
struct Increment {
    state: MachineState,
    row: CycleRow,
    /// Range of its moments in the history.
    moments: Range<usize>,
}

/// A machine ready to run cycles on a contact.
#[non_exhaustive]
pub struct Simulator<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// The kinematics, zeroed at the neutral position.
    pub chain: &'a Chain,
    /// The contact between its parts.
    pub contact: &'a mut dyn ContactModel,
    /// Settings of the time integration.
    pub time: &'a TimeSettings,
    /// Counts of the work done.
    pub counters: SolverCounters,
    /// The last solution of every increment, by the phase at its end; may be empty.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// The history of the present cycle; before it, any history whose memory may be reused.
    pub history: CycleHistory,
    /// Lengths of the residuals of all Newton iterations of the last implicit increment, N, moments on a lever of 10 mm.
    pub residuals_n: Vec<f64>,
    /// The energy of the contact in explicit steps of the present cycle.
    pub(super) energy: ContactEnergy,
}

impl<'a> Simulator<'a> {
    /// Creates a machine on a contact that has not run yet.
    pub fn new(
        machine: &'a Machine,
        chain: &'a Chain,
        contact: &'a mut dyn ContactModel,
        time: &'a TimeSettings,
    ) -> Self {
        Self {
            machine,
            chain,
            contact,
            time,
            counters: SolverCounters::default(),
            warm_starts: Vec::new(),
            history: CycleHistory::default(),
            residuals_n: Vec::new(),
            energy: ContactEnergy::default(),
        }
    }

    /// Solves increments from `start` until one ends in the state of the machine one cycle earlier: the increments
    /// between are a cycle that repeats itself.
    ///
    /// A motion that starts, or that follows a change of the geometry, requires little more than one cycle for that,
    /// seldom two. Further calls on the same contact solve the cycles of further activities. `watch` receives the number of
    /// increments solved after each; its break stops the solution.
    ///
    /// # Errors
    /// An increment that cannot be solved.
    pub fn cycle(
        &mut self,
        start: &MachineState,
        watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Cycle>, CycleError> {
        let count = self.time.increments;
        let first = (start.phase * count as f64).round() as usize;
        let mut state = *start;
        let mut increments: Vec<Option<Increment>> = vec![None; count];
        self.history.clear(count);
        self.contact.begin_cycle();
        self.energy = ContactEnergy::default();
        let mut repeats = false;
        let mut solved = 0;
        while !repeats && solved < count * self.time.most_cycles_to_repeat {
            let place = (first + solved) % count;
            // Warm starts and contact histories belong to a place in the cycle.
            self.contact.begin_increment(place);
            let to = (place + 1) as f64 / count as f64;
            let end = match self.time.integration {
                Integration::Implicit => self.implicit(&state, to),
                Integration::Explicit { least_step_s } => self.explicit(&state, to, least_step_s),
            }?;
            state = end.state;
            let here = self.record(place, &end);
            let rests = self.contact.moved_in_a_cycle_mm() <= self.time.repeat_tolerance_mm;
            let is_met = |before: Increment| {
                rests && self.time.is_repeated(self.machine, &state, &before.state)
            };
            repeats = increments[place].replace(here).is_some_and(is_met);
            // The phase restarts with every cycle, so that it loses no digits over many cycles.
            state.phase %= 1.0;
            solved += 1;
            if watch(solved).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        let increments = || increments.iter().flatten();
        let instants: Vec<_> = increments().map(|here| here.moments.clone()).collect();
        self.history.sort(self.contact.node_count(), &instants);
        Ok(ControlFlow::Continue(Cycle {
            rows: increments().map(|here| here.row).collect(),
            history: std::mem::take(&mut self.history),
            instants,
            end: state,
            warm_starts: std::mem::take(&mut self.warm_starts),
            increments_solved: solved,
            repeats,
        }))
    }

    /// Records an increment that has just been solved.
    ///
    /// Every touched node's pressure and slip represent the whole increment: the trapezoidal rule
    /// of a cycle that repeats, second order in the increment.
    fn record(&mut self, place: usize, end: &Stepped) -> Increment {
        let percent = 100.0 * (place + 1) as f64 / self.time.increments as f64;
        let contact = self.contact.evaluate(&end.motion);
        let increment_s = self.time.increment_s(self.machine.frequency_hz);
        let record = |touched: &TouchedNode| Record {
            node: touched.node,
            pressed_mm2: touched.covered_mm2 as f32,
            moment: Moment {
                pressure_mpa: touched.pressure_mpa,
                slip_mm: [0, 1].map(|along| {
                    touched.sliding_mm_per_s[along] * increment_s - touched.along_mm[along]
                }),
            },
        };
        let moments = contact.touched.iter().map(record);
        Increment {
            state: end.state,
            row: CycleRow::new(percent, end.state.now.positions, &contact),
            moments: self.history.record(moments),
        }
    }

    /// Advances the machine by an increment to the phase `to` with the implicit integrator.
    ///
    /// A step that does not converge is halved, and leaves no warm start.
    ///
    /// # Errors
    /// An increment that does not converge.
    pub fn step(&mut self, state: &MachineState, to: f64) -> Result<MachineState, CycleError> {
        Ok(self.implicit(state, to)?.state)
    }

    /// Returns the largest force out of balance at a state, N; for moments, on a lever of 10 mm.
    pub fn out_of_balance_n(&mut self, state: &MachineState) -> f64 {
        let balance = Balance::new(self.machine, self.chain, self.contact, state.now);
        let residual = balance.residual(&self.machine.loads_at(state.phase));
        self.machine.levers().largest_n(&residual)
    }

    /// Solves an increment with the implicit integrator, with its warm start from the last cycle.
    fn implicit(&mut self, state: &MachineState, to: f64) -> Result<Stepped, CycleError> {
        self.residuals_n.clear();
        let count = self.time.increments;
        self.warm_starts.resize(count, None);
        // Rounded: `to` is a multiple of the increment up to rounding.
        let place = (to * count as f64).round() as usize % count;
        let last = self.warm_starts[place];
        let end = self.advance(state, to, last, MAX_HALVINGS)?;
        self.warm_starts[place] = end.warm_start;
        Ok(end)
    }

    /// Steps to a phase, in halves if a step does not converge or is not exact enough. The contact
    /// accepts every step from which the machine continues.
    fn advance(
        &mut self,
        state: &MachineState,
        to: f64,
        warm_start: Option<WarmStart>,
        halvings: u32,
    ) -> Result<Stepped, CycleError> {
        match self.settled_step(state, to - state.phase, warm_start) {
            Ok(mut next) if halvings == 0 || self.is_exact_enough(state, &next.state) => {
                self.contact.accept(&next.motion);
                // Exactly `to`, which the sum of phase and step may miss by rounding.
                next.state.phase = to;
                Ok(next)
            }
            Err(failed) if halvings == 0 => Err(failed),
            Ok(_) | Err(_) => {
                // The halves start from the history before the rejected step.
                self.contact.reject();
                self.counters.halvings += 1;
                let half = (state.phase + to) / 2.0;
                let middle = self.advance(state, half, None, halvings - 1)?;
                let end = self.advance(&middle.state, to, None, halvings - 1)?;
                Ok(Stepped {
                    warm_start: None,
                    ..end
                })
            }
        }
    }

    /// Takes an implicit step, repeated until the contact's own state agrees with the load at its end.
    fn settled_step(
        &mut self,
        from: &MachineState,
        step: f64,
        mut warm_start: Option<WarmStart>,
    ) -> Result<Stepped, CycleError> {
        for _ in 0..MAX_TURNS {
            let ended = self.implicit_step(from, step, warm_start.as_ref())?;
            let settled = self.contact.settle(&ended.motion);
            let percent = 100.0 * ended.state.phase;
            if settled.map_err(|why| CycleError::NotBorne { percent, why })? == Settled::Yes {
                return Ok(ended);
            }
            warm_start = ended.warm_start;
        }
        Err(CycleError::Unsettled {
            percent: 100.0 * (from.phase + step),
            turns: MAX_TURNS,
        })
    }
}
