//! The contact evaluations that the machine requests in one gait cycle.

use std::ops::ControlFlow;

use condyle::{
    contact::{
        ContactCache, ContactMemory, ContactModel, ContactResult, ContactState, Response, Tangent,
    },
    evolve::{March, WearTest},
    geometry::ArticulatingSurface,
    machine::{Chain, Drive, Simulator, Waveform, knee},
    spatial::RelativeMotion,
};
use condyle_case::case::Case;

use crate::cases;

/// A requested evaluation.
#[derive(Clone, Copy)]
pub struct Asked {
    pub motion: RelativeMotion,
    /// Number of its increment in the cycle.
    pub increment: usize,
    /// True if it is the first of its increment: the femur has moved on, and new candidates for contact are
    /// searched.
    pub is_first: bool,
}

/// A contact that records the requested evaluations.
struct Recorder<'a> {
    contact: Box<dyn ContactModel + 'a>,
    asked: Vec<Asked>,
    increment: usize,
    is_first: bool,
}

impl ContactModel for Recorder<'_> {
    fn node_count(&self) -> usize {
        self.contact.node_count()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
        self.contact.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response {
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

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        self.is_first = true;
        self.contact.evaluate(motion)
    }
}

/// A test about to solve the cycle of one of its updates.
pub struct Gait<'a> {
    march: &'a March,
    chain: Chain,
    surface: ArticulatingSurface,
}

impl<'a> Gait<'a> {
    /// The next update of a march.
    pub fn of(march: &'a March) -> Self {
        let test = march.test();
        let chain = Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm);
        Self {
            march,
            chain,
            surface: march.surface(),
        }
    }

    /// The contact, which has seen nothing yet.
    pub fn contact(&self) -> Box<dyn ContactModel + '_> {
        self.contact_after(ContactCache::default())
    }

    /// The contact, which knows what that of the update before knew.
    pub fn contact_after(&self, cache: ContactCache) -> Box<dyn ContactModel + '_> {
        let state = ContactState::default();
        let law = &self.march.test().contact;
        law.contact(
            self.march.bodies(&self.surface),
            ContactMemory { state, cache },
        )
    }

    /// Solves increments until the motion repeats itself; gives how many.
    pub fn solve(&self, contact: &mut dyn ContactModel) -> usize {
        let (test, own) = (self.march.test(), &self.march.state().activities[0]);
        let mut simulator = Simulator::new(test.machine(), &self.chain, contact, &test.time);
        simulator.warm_starts.clone_from(&own.warm_starts);
        let watch = &mut |_| ControlFlow::Continue(());
        let cycle = simulator
            .cycle(&own.machine, watch)
            .unwrap_or_else(|error| panic!("{error}"));
        cycle
            .continue_value()
            .expect("nobody stops it")
            .increments_solved
    }

    /// The evaluations that this asks for.
    pub fn asked(&self) -> Vec<Asked> {
        let mut recorder = Recorder {
            contact: self.contact(),
            asked: Vec::new(),
            increment: 0,
            is_first: true,
        };
        self.solve(&mut recorder);
        recorder.asked
    }
}

/// The first updates of a test.
pub struct Updates {
    /// About to solve each of them.
    marches: Vec<March>,
    /// The requested evaluations of each update.
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

    /// Returns the requested evaluations of an update.
    pub fn asked(&self, update: usize) -> &[Asked] {
        &self.asked[update]
    }

    /// Returns the cache of its contact after the evaluations of all earlier updates.
    pub fn cache(&self, update: usize) -> ContactCache {
        let mut cache = ContactCache::default();
        for (before, asked) in self.asked[..update].iter().enumerate() {
            let gait = self.gait(before);
            let mut contact = gait.contact_after(cache);
            for asked in asked {
                contact.begin_increment(asked.increment);
                contact.respond(&asked.motion);
            }
            cache = contact.into_memory().cache;
        }
        cache
    }
}

/// Sets the axial force to one that stays.
pub fn press(test: &mut WearTest, axial_force_n: f64) {
    let axial = test.activities[0].machine.joint_mut(knee::IS);
    axial.drive = Drive::Loaded(Waveform::constant(-axial_force_n));
}
