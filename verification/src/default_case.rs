//! The default case's gait cycle on the unworn insert, solved at any resolution.

use std::{ops::ControlFlow, path::Path};

use condyle::{
    contact::Foundation,
    evolve::{March, WearTest},
    machine::{
        Chain, CycleRow, Integration, MachineState, Simulator, SolverCounters, TimeSettings,
    },
};

use crate::{
    marched::{bodies_of, case_in, started},
    observed::{Instant, Observed},
};

/// Largest distance between the ends of a repeating cycle, mm.
const REPEATS_MM: f64 = 1e-5;
/// The same of rotations, rad.
const REPEATS_RAD: f64 = 1e-7;

/// The default case, its femur settled on the insert.
pub(crate) struct DefaultCase {
    march: March,
    law: Foundation,
}

/// A cycle that repeats itself.
pub(crate) struct Solved {
    /// One per increment.
    pub rows: Vec<CycleRow>,
    /// The contact at the end of every increment.
    pub contact: Vec<Instant>,
    pub counters: SolverCounters,
}

/// Returns the text of `cases/knight-2007.toml` with the AP force in the direction of the other cases.
pub(crate) fn text() -> String {
    let paper = include_str!("../../cases/knight-2007.toml");
    paper.replace("ap_force_sign = -1", "ap_force_sign = 1")
}

impl DefaultCase {
    pub(crate) fn new() -> Self {
        let (march, law) = started(&case_in(&text(), Path::new("")));
        Self { march, law }
    }

    pub(crate) fn test(&self) -> &WearTest {
        self.march.test()
    }

    pub(crate) fn chain(&self) -> Chain {
        let (test, zero_mm) = (self.test(), self.march.state().zero_mm);
        Chain::new(test.machine(), zero_mm, test.flexion_axis_mm)
    }

    /// The machine at rest, where the femur settled.
    fn start(&self) -> MachineState {
        self.march.state().activities[0].machine
    }

    /// Cycles from rest, where the femur settled, until one repeats itself.
    pub(crate) fn solved(&self, increments: usize, integration: Integration) -> Solved {
        let (test, chain) = (self.test(), self.chain());
        let time = TimeSettings {
            increments,
            integration,
            force_tolerance_n: 1e-4,
            repeat_tolerance_mm: REPEATS_MM,
            repeat_tolerance_rad: REPEATS_RAD,
            ..test.time
        };
        let surface = self.march.insert().surface();
        let mut contact = Observed::new(&self.law, bodies_of(&self.march, &surface));
        let mut simulator = Simulator::new(test.machine(), &chain, &mut contact, &time);
        let mut watch = |_| ControlFlow::Continue(());
        let cycle = simulator
            .cycle(&self.start(), &mut watch)
            .expect("a shipped case is solved")
            .continue_value()
            .expect("nobody stops it");
        assert!(cycle.repeats, "no cycle repeats itself");
        let counters = simulator.counters;
        Solved {
            rows: cycle.rows,
            contact: last_of_each_place(&contact.instants, increments),
            counters,
        }
    }
}

/// Of increments that started at 0 % and went on beyond a cycle, the last at every place.
fn last_of_each_place(seen: &[Instant], increments: usize) -> Vec<Instant> {
    let last = |place: usize| {
        let rounds = (seen.len() - 1 - place) / increments;
        seen[place + rounds * increments]
    };
    (0..increments).map(last).collect()
}
