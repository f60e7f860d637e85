//! One gait cycle: motions, loads and contact at every increment.

use serde::{Deserialize, Serialize};
use std::ops::{ControlFlow, Range};

use thiserror::Error;

use super::{
    Chain, FREEDOMS, Freedom, Integration, Machine, TimeSettings, WarmStart,
    balance::{Balance, Kinematics},
    explicit::{Explicit, NoStep},
    integrator::{
        Integrator, MachineState, NotConverged, SolverCounters, drive, loads_at, out_of_balance_n,
        step_error_mm,
    },
};
use crate::contact::{ContactModel, CycleHistory, Landing, MOST_REGIONS, Moment, TouchedNode};

/// How often a step may be halved before it is given up.
const MOST_HALVINGS: u32 = 8;

/// The machine at the end of an increment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRow {
    /// Place in the cycle, %.
    pub percent: f64,
    /// Positions, mm or rad, in the order of [`FREEDOMS`].
    pub positions: [f64; 6],
    /// Load pressing the bodies together along y, as the contact carries it, N.
    pub axial_force_n: f64,
    /// Area in contact, mm2.
    pub contact_area_mm2: f64,
    /// Highest pressure anywhere, at a node or between nodes, MPa.
    pub peak_pressure_mpa: f64,
    /// Part of the axial force on every region of the surface, N.
    pub region_force_n: [f64; MOST_REGIONS],
}

/// A solved cycle.
pub struct Cycle {
    /// One row an increment.
    pub rows: Vec<CycleRow>,
    /// What every node of the articulating surface went through.
    pub history: CycleHistory,
    /// The machine when it was found to repeat itself.
    pub end: MachineState,
    /// How every increment was solved, for a next cycle like it.
    pub warm_starts: Vec<Option<WarmStart>>,
    /// Increments solved until then.
    pub increments_solved: usize,
    /// Whether it did repeat itself, within the cycles that it was given.
    pub repeats: bool,
}

/// An increment as it was left.
#[derive(Clone)]
struct Landed {
    state: MachineState,
    row: CycleRow,
    /// Where its moments are recorded.
    moments: Range<usize>,
}

/// Why a cycle was not solved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CycleError {
    /// An increment that does not converge even in the smallest steps.
    #[error(
        "the machine finds no balance at {percent:.2} % of the cycle: {residual_n:.3e} N are left over at {}; \
         check loads and springs there, or use more increments",
        places(positions)
    )]
    NotConverged {
        /// Place in the cycle, %.
        percent: f64,
        /// Positions at the last iteration, mm and rad, in the order of [`FREEDOMS`].
        positions: [f64; 6],
        /// Force left out of balance, N.
        residual_n: f64,
    },
    /// Explicit steps whose motion left all bounds.
    #[error(
        "explicit steps leave all bounds at {percent:.2} % of the cycle, past {}; check loads and springs there, or \
         take the implicit integrator",
        places(positions)
    )]
    Unstable {
        /// Place in the cycle, %.
        percent: f64,
        /// Positions before it, mm and rad, in the order of [`FREEDOMS`].
        positions: [f64; 6],
    },
    /// Explicit steps of a freedom that weighs nothing.
    #[error(
        "the explicit integrator needs inertia on every loaded freedom, and {freedom:?} has none; give it some, or \
         take the implicit integrator"
    )]
    NoInertia {
        /// Which freedom.
        freedom: Freedom,
    },
}

fn places(positions: &[f64; 6]) -> String {
    let [vv, ie, ml, ap, is, flexion] = *positions;
    let [vv, ie, flexion] = [vv, ie, flexion].map(f64::to_degrees);
    format!(
        "AP {ap:.3} mm, ML {ml:.3} mm, IS {is:.3} mm, IE {ie:.3} deg, VV {vv:.3} deg, flexion {flexion:.2} deg"
    )
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

impl MachineState {
    /// A machine at rest at the start of a cycle, at the given positions where it is free.
    pub fn at_rest(machine: &Machine, positions: [f64; 6]) -> Self {
        let mut now = Kinematics {
            positions,
            rates: [0.0; 6],
            accelerations: [0.0; 6],
        };
        drive(machine, 0.0, &mut now.positions, &mut now.rates);
        Self {
            phase: 0.0,
            now,
            before: None,
        }
    }

    /// Whether the machine is where it was at `earlier` and moves as it did, within the
    /// tolerances; rates count by how far they lead in `lead_s`.
    fn repeats(&self, earlier: &Self, time: &TimeSettings, lead_s: f64) -> bool {
        FREEDOMS.iter().all(|&freedom| {
            let j = freedom as usize;
            let apart = (self.now.positions[j] - earlier.now.positions[j]).abs();
            let parting = (self.now.rates[j] - earlier.now.rates[j]).abs() * lead_s;
            let tolerance = if freedom.is_rotation() {
                time.repeat_tolerance_rad
            } else {
                time.repeat_tolerance_mm
            };
            apart.max(parting) <= tolerance
        })
    }
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
    /// increments since then are one cycle that repeats itself.
    ///
    /// A motion that starts or that follows a change of the geometry needs a little more than a
    /// cycle for that, and seldom two. `watch` is told how many increments are solved, and may
    /// stop it.
    ///
    /// # Errors
    /// An increment that does not converge, or a stop asked for.
    pub fn cycle(
        &mut self,
        start: &MachineState,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
    ) -> Result<ControlFlow<(), Cycle>, CycleError> {
        let count = self.time.increments;
        let first = (start.phase * count as f64).round() as usize;
        let mut state = *start;
        let mut landed: Vec<Option<Landed>> = vec![None; count];
        self.history.clear(count);
        let mut repeats = false;
        let mut solved = 0;
        while !repeats && solved < count * self.time.most_cycles_to_repeat {
            let place = (first + solved) % count;
            let to = (place + 1) as f64 / count as f64;
            self.contact.begin_increment(place);
            state = match self.time.integration {
                Integration::Implicit => self.step(&state, to, counters, &mut |_| ())?,
                Integration::Explicit { least_step_s } => Explicit {
                    machine: self.machine,
                    chain: self.chain,
                    contact: self.contact,
                    least_step_s,
                    counters,
                }
                .advance(&state, to)?,
            };
            let here = self.land(place, &state);
            repeats = landed[place]
                .replace(here)
                .is_some_and(|before| state.repeats(&before.state, self.time, self.increment_s()));
            state.phase %= 1.0;
            solved += 1;
            if watch(solved).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        let cycle = self.gather(&landed, state, solved, repeats);
        Ok(ControlFlow::Continue(cycle))
    }

    /// What is to be kept of the increment that has just been solved.
    ///
    /// Every touched node's pressure and slip stand for the whole increment: the trapezoidal rule
    /// of a cycle that repeats, second order in the increment.
    fn land(&mut self, place: usize, state: &MachineState) -> Landed {
        let percent = 100.0 * (place + 1) as f64 / self.time.increments as f64;
        let configuration = self.chain.at(&state.now.positions);
        let motion = configuration.motion(&state.now.rates);
        let landing = self.contact.land(&motion);
        let increment_s = self.increment_s();
        let moment = |node: &TouchedNode| Moment {
            pressure_mpa: node.pressure_mpa,
            slip_mm: node.sliding_mm_per_s.map(|speed| speed * increment_s),
        };
        let moments = landing.touched.iter().map(|node| (node.node, moment(node)));
        Landed {
            state: *state,
            row: row(percent, state, &landing),
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
            end,
            warm_starts: std::mem::take(&mut self.warm_starts),
            increments_solved: solved,
            repeats,
        }
    }

    fn increment_s(&self) -> f64 {
        1.0 / (self.machine.frequency_hz * self.time.increments as f64)
    }

    /// The machine at the phase `to`, an increment after `state`, by the implicit integrator.
    ///
    /// `watch` is told the length of the residual at every iteration of Newton's method, N, moments
    /// on a lever of 10 mm. A step that does not converge is taken in halves, and is no warm_start.
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
        let count = self.time.increments;
        self.warm_starts.resize(count, None);
        let place = (to * count as f64).round() as usize % count;
        let last = self.warm_starts[place];
        let (end, warm_start) =
            self.advance(state, to, last.as_ref(), MOST_HALVINGS, counters, watch)?;
        self.warm_starts[place] = warm_start;
        Ok(end)
    }

    /// Largest force out of balance at a state, N; for moments, on a lever of 10 mm.
    pub fn out_of_balance_n(&mut self, state: &MachineState) -> f64 {
        let balance = Balance::new(self.machine, self.chain, self.contact, state.now);
        out_of_balance_n(&balance.residual(&loads_at(self.machine, state.phase)))
    }

    /// Steps to a phase, in halves where a step does not converge or is not exact enough; and what
    /// is to be known of the step the next time, if it was one.
    fn advance(
        &mut self,
        state: &MachineState,
        to: f64,
        warm_start: Option<&WarmStart>,
        halvings: u32,
        counters: &mut SolverCounters,
        watch: &mut dyn FnMut(f64),
    ) -> Result<(MachineState, Option<WarmStart>), CycleError> {
        let mut integrator = Integrator {
            machine: self.machine,
            chain: self.chain,
            contact: self.contact,
            force_tolerance_n: self.time.force_tolerance_n,
            foresees: self.time.foresees,
            counters,
        };
        match integrator.step(state, to - state.phase, warm_start, watch) {
            Ok((next, warm_start)) if halvings == 0 || self.is_exact_enough(state, &next) => {
                let ended = self.chain.at(&next.now.positions).motion(&next.now.rates);
                self.contact.accept(&ended);
                Ok((MachineState { phase: to, ..next }, Some(warm_start)))
            }
            Err(failed) if halvings == 0 => Err(failed.into()),
            _ => {
                counters.halvings += 1;
                let half = (state.phase + to) / 2.0;
                let (middle, _) = self.advance(state, half, None, halvings - 1, counters, watch)?;
                let (end, _) = self.advance(&middle, to, None, halvings - 1, counters, watch)?;
                Ok((end, None))
            }
        }
    }

    fn is_exact_enough(&self, from: &MachineState, to: &MachineState) -> bool {
        let at_most_mm = self.time.increment_error_mm;
        at_most_mm == 0.0 || step_error_mm(self.machine, from, to) <= at_most_mm
    }
}

impl From<NotConverged> for CycleError {
    fn from(failed: NotConverged) -> Self {
        Self::NotConverged {
            percent: 100.0 * failed.phase,
            positions: failed.positions,
            residual_n: failed.residual_n,
        }
    }
}

impl From<NoStep> for CycleError {
    fn from(failed: NoStep) -> Self {
        match failed {
            NoStep::NoInertia(freedom) => Self::NoInertia { freedom },
            NoStep::Unstable { phase, positions } => Self::Unstable {
                percent: 100.0 * phase,
                positions,
            },
        }
    }
}

fn row(percent: f64, state: &MachineState, landing: &Landing) -> CycleRow {
    let (mut region_force_n, mut contact_area_mm2) = ([0.0; MOST_REGIONS], 0.0);
    for node in &landing.touched {
        region_force_n[usize::from(node.region)] -= node.force_n.y;
        contact_area_mm2 += node.covered_mm2;
    }
    CycleRow {
        percent,
        positions: state.now.positions,
        axial_force_n: region_force_n.iter().sum(),
        contact_area_mm2,
        peak_pressure_mpa: landing.peak_pressure_mpa,
        region_force_n,
    }
}
