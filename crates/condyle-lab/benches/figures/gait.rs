//! What the machine asks of the contact in one gait cycle.

use std::ops::ControlFlow;

use condyle::{
    Vec3,
    contact::{ContactModel, Foundation, RelativeMotion, Tangent, TouchedNode, Vec6},
    evolve::{March, WearTest},
    machine::{Chain, Drive, Effort, Freedom, Machine, MachineState, Simulator, Waveform, settle},
};

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

/// A test on its unworn insert, about to solve its first cycle.
pub struct Gait<'a> {
    test: &'a WearTest,
    chain: Chain,
    machine: Machine,
    start: MachineState,
}

impl<'a> Gait<'a> {
    /// The gait of the case.
    pub fn of(march: &'a March) -> Self {
        let test = march.test();
        Self {
            test,
            chain: Chain::new(&test.machine, march.state().zero_mm, test.flexion_axis_mm),
            machine: test.machine.clone(),
            start: march.state().machine,
        }
    }

    /// The same with an axial force that stays.
    pub fn under(march: &'a March, axial_force_n: f64) -> Self {
        let mut gait = Self::of(march);
        gait.machine.freedoms[Freedom::InferoSuperior as usize].drive =
            Drive::Loaded(Waveform::constant(-axial_force_n));
        let tolerance_n = gait.test.time.force_tolerance_n;
        let effort = &mut Effort::default();
        let settled = settle(
            &gait.machine,
            &gait.chain,
            &mut gait.contact(),
            tolerance_n,
            effort,
        )
        .unwrap_or_else(|failed| panic!("under {axial_force_n} N: {failed:?}"));
        gait.start = MachineState::at_rest(&gait.machine, settled);
        gait
    }

    /// The contact, which has seen nothing yet.
    pub fn contact(&self) -> Foundation<'a> {
        Foundation::new(&self.test.contact, &self.test.femur, &self.test.insert)
    }

    /// Solves increments until the motion repeats itself; gives how many.
    pub fn solve(&self, contact: impl ContactModel) -> usize {
        self.solved(contact).0
    }

    fn solved<C: ContactModel>(&self, contact: C) -> (usize, C) {
        let mut simulator = Simulator::new(&self.machine, &self.chain, contact, &self.test.time);
        let watch = &mut |_| ControlFlow::Continue(());
        let cycle = simulator
            .cycle(&self.start, &mut Effort::default(), watch)
            .unwrap_or_else(|error| panic!("{error}"));
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
