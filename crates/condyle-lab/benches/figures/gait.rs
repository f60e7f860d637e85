//! What the machine asks of the contact in one gait cycle.

use std::ops::ControlFlow;

use condyle::{
    Vec3,
    contact::{ContactModel, Former, Foundation, RelativeMotion, Tangent, TouchedNode, Vec6},
    evolve::{March, WearTest},
    machine::{Chain, Drive, Simulator, SolverCounters, Waveform, knee},
};
use condyle_io::case::Case;

use crate::cases;

/// An evaluation that was asked for.
#[derive(Clone, Copy)]
pub struct Asked {
    pub motion: RelativeMotion,
    /// Of which increment of the cycle it is.
    pub increment: usize,
    /// Whether it is the first of its increment: the femur has moved on, and what has come near is
    /// looked for.
    pub is_first: bool,
}

/// A contact that writes down what it is asked.
struct Recorder<'a> {
    contact: Foundation<'a>,
    asked: Vec<Asked>,
    increment: usize,
    is_first: bool,
}

impl ContactModel for Recorder<'_> {
    fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
        self.contact.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
        self.asked.push(Asked {
            motion: *motion,
            increment: self.increment,
            is_first: std::mem::take(&mut self.is_first),
        });
        self.contact.respond(motion)
    }

    fn tangent(&self) -> Tangent {
        self.contact.tangent()
    }

    fn mean_slip(&self) -> [Vec3; 2] {
        self.contact.mean_slip()
    }

    fn node_count(&self) -> usize {
        self.contact.node_count()
    }

    fn touched(&mut self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        self.is_first = true;
        self.contact.touched(motion)
    }

    fn peak_pressure_mpa(&self, motion: &RelativeMotion, touched: &[TouchedNode]) -> f64 {
        self.contact.peak_pressure_mpa(motion, touched)
    }
}

/// A test about to solve the cycle of one of its updates.
pub struct Gait<'a> {
    march: &'a March,
    chain: Chain,
}

impl<'a> Gait<'a> {
    /// The next update of a march.
    pub fn of(march: &'a March) -> Self {
        let test = march.test();
        let chain = Chain::new(&test.machine, march.state().zero_mm, test.flexion_axis_mm);
        Self { march, chain }
    }

    /// The contact, which has seen nothing yet.
    pub fn contact(&self) -> Foundation<'a> {
        self.contact_after(None)
    }

    /// The contact, which knows what that of the update before knew.
    pub fn contact_after(&self, former: Option<Former>) -> Foundation<'a> {
        let test = self.march.test();
        Foundation::after(former, &test.contact, &test.femur, &test.insert)
    }

    /// Solves increments until the motion repeats itself; gives how many.
    pub fn solve(&self, contact: impl ContactModel) -> usize {
        self.solved(contact).0
    }

    fn solved<C: ContactModel>(&self, contact: C) -> (usize, C) {
        let (test, state) = (self.march.test(), self.march.state());
        let mut simulator = Simulator::new(&test.machine, &self.chain, contact, &test.time);
        simulator.warm_starts.clone_from(&state.warm_starts);
        let watch = &mut |_| ControlFlow::Continue(());
        let cycle = simulator
            .cycle(&state.machine, &mut SolverCounters::default(), watch)
            .unwrap_or_else(|error| panic!("{error}"))
            .continue_value()
            .expect("nobody stops it");
        (cycle.increments_solved, simulator.contact)
    }

    /// The evaluations that this asks for.
    pub fn asked(&self) -> Vec<Asked> {
        let recorder = Recorder {
            contact: self.contact(),
            asked: Vec::new(),
            increment: 0,
            is_first: true,
        };
        self.solved(recorder).1.asked
    }
}

/// The first updates of a test.
pub struct Updates {
    /// About to solve each of them.
    marches: Vec<March>,
    /// What each of them asks for.
    asked: Vec<Vec<Asked>>,
}

/// The update whose evaluations are timed and counted: the first that goes on from another.
pub const SECOND: usize = 1;

impl Updates {
    /// `count` of those of a case's test, changed.
    pub fn of(case: &Case, count: usize, change: impl Fn(&mut WearTest)) -> Self {
        let march = |updates| {
            let mut test = cases::built(case);
            change(&mut test);
            cases::updated(test, updates)
        };
        let marches: Vec<March> = (0..count).map(march).collect();
        let asked = marches.iter().map(|march| Gait::of(march).asked());
        Self {
            asked: asked.collect(),
            marches,
        }
    }

    /// The update number `update`, from 0.
    pub fn gait(&self, update: usize) -> Gait<'_> {
        Gait::of(&self.marches[update])
    }

    /// What it asks for.
    pub fn asked(&self, update: usize) -> &[Asked] {
        &self.asked[update]
    }

    /// Its contact, after all those before have asked for theirs.
    pub fn contact(&self, update: usize) -> Foundation<'_> {
        let mut former = None;
        for (before, asked) in self.asked[..update].iter().enumerate() {
            let mut contact = self.gait(before).contact_after(former);
            for asked in asked {
                contact.begin_increment(asked.increment);
                contact.respond(&asked.motion);
            }
            former = Some(contact.into_parts().1);
        }
        self.gait(update).contact_after(former)
    }
}

/// Sets the axial force to one that stays.
pub fn press(test: &mut WearTest, axial_force_n: f64) {
    let axial = test.machine.joint_mut(knee::IS);
    axial.drive = Drive::Loaded(Waveform::constant(-axial_force_n));
}
