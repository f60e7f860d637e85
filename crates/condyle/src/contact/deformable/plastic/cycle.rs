//! What flows in a cycle that repeats itself.

use std::{collections::BTreeMap, sync::Arc};

use super::POINTS;

/// How much more exactly than a motion the surface at rest is to repeat itself: what is added to it stays for all
/// cycles of an interval.
const MORE_EXACTLY: f64 = 20.0;

/// Accumulated plastic strain at the Gauss points of an element.
type Flow = [f64; POINTS];

/// What flowed in each increment when it was solved last, and where the surface at rest was.
#[derive(Default)]
pub(in super::super) struct CycleOfFlow {
    /// Of the increments of the activity that is being solved.
    increments: BTreeMap<usize, Increment>,
    increment: usize,
    /// What the cycles of the activities before come to.
    before: BTreeMap<u32, Flow>,
    /// How far the surface at rest lies from where it lay when the same increment landed a cycle before, mm.
    moved_mm: f64,
}

#[derive(Default)]
struct Increment {
    flows: Vec<(u32, Flow)>,
    set_mm: Option<Arc<Vec<f64>>>,
}

impl CycleOfFlow {
    /// The next increments are of another activity.
    pub fn begin(&mut self) {
        self.before = self.flow();
        self.increments.clear();
    }

    /// The next flows are of this increment.
    pub fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
        self.present().flows.clear();
    }

    /// What accumulated at the points of an element.
    pub fn add(&mut self, element: u32, flow: Flow) {
        self.present().flows.push((element, flow));
    }

    /// The increment has landed on a surface with that permanent set.
    pub fn land(&mut self, set_mm: &Arc<Vec<f64>>) {
        let before = self.present().set_mm.replace(Arc::clone(set_mm));
        self.moved_mm = match before {
            // The surface of no increment is known yet.
            None => f64::INFINITY,
            Some(before) if Arc::ptr_eq(&before, set_mm) => 0.0,
            Some(before) => farthest_mm(&before, set_mm),
        };
    }

    /// How far the surface at rest lies from where it lay a cycle before, mm, so often as it is to be more exact than a
    /// motion.
    pub fn moved_mm(&self) -> f64 {
        MORE_EXACTLY * self.moved_mm
    }

    /// What accumulated in the last cycle of every activity, by elements.
    pub fn flow(&self) -> BTreeMap<u32, Flow> {
        let mut sums = self.before.clone();
        let increments = self.increments.values();
        for (element, flow) in increments.flat_map(|increment| &increment.flows) {
            let sum = sums.entry(*element).or_default();
            for (sum, flow) in sum.iter_mut().zip(flow) {
                *sum += flow;
            }
        }
        sums
    }

    fn present(&mut self) -> &mut Increment {
        self.increments.entry(self.increment).or_default()
    }
}

/// How far apart two surfaces lie at most, mm.
pub(in super::super) fn farthest_mm(one_mm: &[f64], other_mm: &[f64]) -> f64 {
    let apart = one_mm.iter().zip(other_mm).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}
