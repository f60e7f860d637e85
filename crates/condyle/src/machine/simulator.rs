//! One gait cycle, increment by increment, until it repeats itself.

use std::ops::{ControlFlow, Range};

use super::{
    Chain, Cycle, CycleError, CycleRow, Integration, Machine, MachineState, Mechanism,
    SolverCounters, TimeSettings, WarmStart,
    balance::Balance,
    cycle::Repetition,
    explicit::Explicit,
    implicit::{Implicit, NotConverged, Stepped, step_error_mm},
};
use crate::{
    contact::{ContactModel, CycleHistory, Moment, NotBorne, Record, Settled, TouchedNode},
    spatial::RelativeMotion,
};

/// How often a step may be halved before it is given up.
const MAX_HALVINGS: u32 = 8;
/// How often a step is solved anew for a contact whose own state goes with the load; each time that state is right to
/// about three times as much.
const MAX_TURNS: u32 = 20;

/// Where the machine goes on from.
struct Accepted {
    state: MachineState,
    /// The femur's motion past the insert there, which the contact has accepted.
    motion: RelativeMotion,
    /// How the way there was solved, if it was one implicit step.
    warm_start: Option<WarmStart>,
}

/// An increment as it was left.
#[derive(Clone)]
struct Landed {
    state: MachineState,
    row: CycleRow,
    /// Where its moments are recorded.
    moments: Range<usize>,
}

/// A machine ready to run cycles on a contact.
pub struct Simulator<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// Its kinematics, zeroed at the neutral position.
    pub chain: &'a Chain,
    /// The contact between its parts.
    pub contact: &'a mut dyn ContactModel,
    /// How finely and exactly it is solved.
    pub time: &'a TimeSettings,
    /// How the increments were solved the last time, by the phase they end at; empty before.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// The history of the cycle that runs; before, any that is no longer needed, for its memory.
    pub history: CycleHistory,
}

impl<'a> Simulator<'a> {
    /// A machine on a contact that has not run yet.
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
            warm_starts: Vec::new(),
            history: CycleHistory::default(),
        }
    }

    /// Solves increments from `start` until one lands where the machine was a cycle before: the
    /// increments since then are one cycle that repeats itself. Breaks where `watch` does.
    ///
    /// A motion that starts or that follows a change of the geometry needs a little more than a
    /// cycle for that, and seldom two. `watch` is told how many increments are solved.
    ///
    /// # Errors
    /// An increment that cannot be solved.
    pub fn cycle(
        &mut self,
        start: &MachineState,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Cycle>, CycleError> {
        let count = self.time.increments;
        let first = (start.phase * count as f64).round() as usize;
        let repetition = Repetition::new(self.machine, self.time);
        let mut state = *start;
        let mut landed: Vec<Option<Landed>> = vec![None; count];
        self.history.clear(count);
        self.contact.begin_cycle();
        let mut repeats = false;
        let mut solved = 0;
        while !repeats && solved < count * self.time.most_cycles_to_repeat {
            let place = (first + solved) % count;
            self.contact.begin_increment(place);
            let end = self.increment(&state, place, counters)?;
            state = end.state;
            let here = self.land(place, &end);
            let rests = self.contact.moved_in_a_cycle_mm() <= self.time.repeat_tolerance_mm;
            repeats = landed[place]
                .replace(here)
                .is_some_and(|before| rests && repetition.is_met(&state, &before.state));
            state.phase %= 1.0;
            solved += 1;
            if watch(solved).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        let cycle = self.gather(&landed, state, solved, repeats);
        Ok(ControlFlow::Continue(cycle))
    }

    /// Solves the increment number `place` of the cycle.
    fn increment(
        &mut self,
        state: &MachineState,
        place: usize,
        counters: &mut SolverCounters,
    ) -> Result<Accepted, CycleError> {
        let to = (place + 1) as f64 / self.time.increments as f64;
        match self.time.integration {
            Integration::Implicit => self.implicit(state, to, counters, &mut |_| ()),
            Integration::Explicit { least_step_s } => {
                self.explicit(state, to, least_step_s, counters)
            }
        }
    }

    /// What is to be kept of the increment that has just been solved.
    ///
    /// Every touched node's pressure and slip stand for the whole increment: the trapezoidal rule
    /// of a cycle that repeats, second order in the increment.
    fn land(&mut self, place: usize, end: &Accepted) -> Landed {
        let percent = 100.0 * (place + 1) as f64 / self.time.increments as f64;
        let landing = self.contact.evaluate(&end.motion);
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
        let moments = landing.touched.iter().map(record);
        Landed {
            state: end.state,
            row: CycleRow::new(percent, end.state.now.positions, &landing),
            moments: self.history.record(moments),
        }
    }

    fn gather(
        &mut self,
        landed: &[Option<Landed>],
        end: MachineState,
        solved: usize,
        repeats: bool,
    ) -> Cycle {
        let landed = || landed.iter().flatten();
        let instants: Vec<_> = landed().map(|here| here.moments.clone()).collect();
        self.history.sort(self.contact.node_count(), &instants);
        Cycle {
            rows: landed().map(|here| here.row).collect(),
            history: std::mem::take(&mut self.history),
            instants,
            end,
            warm_starts: std::mem::take(&mut self.warm_starts),
            increments_solved: solved,
            repeats,
        }
    }

    /// The machine at the phase `to`, an increment after `state`, by the implicit integrator.
    ///
    /// `watch` is told the length of the residual at every Newton iteration, N, moments on a lever of
    /// 10 mm. A step that does not converge is taken in halves, and is no warm start.
    ///
    /// # Errors
    /// An increment that does not converge.
    pub fn step(
        &mut self,
        state: &MachineState,
        to: f64,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(f64),
    ) -> Result<MachineState, CycleError> {
        let end = self.implicit(state, to, counters, watch)?;
        Ok(end.state)
    }

    /// Largest force out of balance at a state, N; for moments, on a lever of 10 mm.
    pub fn out_of_balance_n(&mut self, state: &MachineState) -> f64 {
        let balance = Balance::new(self.machine, self.chain, self.contact, state.now);
        let residual = balance.residual(&self.machine.loads_at(state.phase));
        residual.largest_n(&self.machine.levers())
    }

    fn explicit(
        &mut self,
        state: &MachineState,
        to: f64,
        least_step_s: f64,
        counters: &mut SolverCounters,
    ) -> Result<Accepted, CycleError> {
        let mut explicit = Explicit {
            machine: self.machine,
            chain: self.chain,
            contact: self.contact,
            least_step_s,
            counters,
        };
        let advanced = explicit.advance(state, to);
        let (state, motion) =
            advanced.map_err(|failed| CycleError::of_explicit(self.machine.mechanism, &failed))?;
        Ok(Accepted {
            state,
            motion,
            warm_start: None,
        })
    }

    /// An increment by the implicit integrator, with its warm start from the last cycle.
    fn implicit(
        &mut self,
        state: &MachineState,
        to: f64,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(f64),
    ) -> Result<Accepted, CycleError> {
        let count = self.time.increments;
        self.warm_starts.resize(count, None);
        let place = (to * count as f64).round() as usize % count;
        let last = self.warm_starts[place];
        let end = self.advance(state, to, last.as_ref(), MAX_HALVINGS, counters, watch)?;
        self.warm_starts[place] = end.warm_start;
        Ok(end)
    }

    /// Steps to a phase, in halves where a step does not converge or is not exact enough. The contact
    /// accepts every step that the machine goes on from.
    fn advance(
        &mut self,
        state: &MachineState,
        to: f64,
        warm_start: Option<&WarmStart>,
        halvings: u32,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(f64),
    ) -> Result<Accepted, CycleError> {
        let mut implicit = Implicit {
            machine: self.machine,
            chain: self.chain,
            contact: self.contact,
            force_tolerance_n: self.time.force_tolerance_n,
            trusts_prediction: self.time.trusts_prediction,
            counters,
        };
        let stepped = settled(&mut implicit, state, to - state.phase, warm_start, watch);
        match stepped {
            Ok(next) if halvings == 0 || self.is_exact_enough(state, &next.state) => {
                self.contact.accept(&next.motion);
                Ok(Accepted {
                    state: MachineState {
                        phase: to,
                        ..next.state
                    },
                    motion: next.motion,
                    warm_start: Some(next.warm_start),
                })
            }
            Err(failed) if halvings == 0 => Err(failed.error(self.machine.mechanism)),
            Ok(_) | Err(_) => {
                self.contact.reject();
                counters.halvings += 1;
                let half = (state.phase + to) / 2.0;
                let middle = self.advance(state, half, None, halvings - 1, counters, watch)?;
                let end = self.advance(&middle.state, to, None, halvings - 1, counters, watch)?;
                Ok(Accepted {
                    warm_start: None,
                    ..end
                })
            }
        }
    }

    fn is_exact_enough(&self, from: &MachineState, to: &MachineState) -> bool {
        let at_most_mm = self.time.increment_error_mm;
        at_most_mm == 0.0 || step_error_mm(self.machine, from, to) <= at_most_mm
    }
}

/// Why an implicit step was given up.
enum GivenUp {
    NotConverged(NotConverged),
    NotBorne { phase: f64, why: NotBorne },
    Unsettled { phase: f64 },
}

impl GivenUp {
    fn error(self, mechanism: &Mechanism) -> CycleError {
        match self {
            Self::NotConverged(failed) => CycleError::of_implicit(mechanism, &failed),
            Self::NotBorne { phase, why } => CycleError::not_borne(phase, why),
            Self::Unsettled { phase } => CycleError::Unsettled {
                percent: 100.0 * phase,
                turns: MAX_TURNS,
            },
        }
    }
}

/// An implicit step at whose end the contact has found its own state: solved anew until it has.
fn settled(
    implicit: &mut Implicit<'_>,
    from: &MachineState,
    step: f64,
    warm_start: Option<&WarmStart>,
    watch: &mut dyn FnMut(f64),
) -> Result<Stepped, GivenUp> {
    let mut last = None;
    for _ in 0..MAX_TURNS {
        let ended = implicit.step(from, step, last.as_ref().or(warm_start), watch);
        let ended = ended.map_err(GivenUp::NotConverged)?;
        let settled = implicit.contact.settle(&ended.motion);
        let not_borne = |why| GivenUp::NotBorne {
            phase: ended.state.phase,
            why,
        };
        if settled.map_err(not_borne)? == Settled::Yes {
            return Ok(ended);
        }
        last = Some(ended.warm_start);
    }
    let phase = from.phase + step;
    Err(GivenUp::Unsettled { phase })
}
