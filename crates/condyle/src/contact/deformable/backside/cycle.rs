//! What the backside does in a cycle.

use std::collections::BTreeMap;

use super::{
    rest::Rest,
    tray::{LockLoad, Tray},
};
use crate::contact::deformable::plastic::farthest_mm;

/// What the backside did at most in the last cycle of any activity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in super::super) struct BacksideCycle {
    /// Farthest that a point lifts off the tray, mm.
    pub lift_mm: f64,
    /// Largest part of the backside that lifts at once.
    pub lifted_part: f64,
    /// Longest way that a point slips along the tray while it presses, there and back, mm.
    pub slip_mm: f64,
    /// Most that the lock carries.
    pub lock: LockLoad,
}

impl BacksideCycle {
    pub fn of_numbers(numbers: &[f64; 5]) -> Self {
        let [lift_mm, lifted_part, slip_mm, force_n, moment_nmm] = *numbers;
        Self {
            lift_mm,
            lifted_part,
            slip_mm,
            lock: LockLoad {
                force_n,
                moment_nmm,
            },
        }
    }

    pub fn numbers(&self) -> [f64; 5] {
        let LockLoad {
            force_n,
            moment_nmm,
        } = self.lock;
        [
            self.lift_mm,
            self.lifted_part,
            self.slip_mm,
            force_n,
            moment_nmm,
        ]
    }

    fn or_more(&self, other: &Self) -> Self {
        let (own, others) = (self.numbers(), other.numbers());
        Self::of_numbers(&std::array::from_fn(|i| own[i].max(others[i])))
    }
}

/// Where each increment landed when it was solved last.
#[derive(Default)]
pub(super) struct CycleOfRest {
    /// Of the increments of the activity that is being solved.
    increments: BTreeMap<usize, Landed>,
    increment: usize,
    /// What the cycles of the activities before come to.
    before: BacksideCycle,
    /// How far the backside lies from where it lay when the same increment landed a cycle before, mm.
    pub moved_mm: f64,
}

struct Landed {
    moved_mm: Vec<f64>,
    presses: Vec<bool>,
    /// All but the slip.
    most: BacksideCycle,
}

impl CycleOfRest {
    /// The next increments are of another activity.
    pub fn begin(&mut self) {
        self.before = self.most();
        self.increments.clear();
    }

    pub fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
    }

    /// The increment has landed with the backside at rest.
    pub fn land(&mut self, tray: &Tray, rest: &Rest) {
        let points = rest.moved_mm.as_chunks::<3>().0;
        let pushes = rest.pushes_n.as_chunks::<3>().0.iter();
        let presses: Vec<bool> = pushes.map(|push| push[2] > 0.0).collect();
        let area = |lifted: bool| -> f64 {
            let points = tray.points.iter().zip(&presses);
            let counted = points.filter(|(_, presses)| !(lifted && **presses));
            counted.map(|(point, _)| point.area_mm2).sum()
        };
        let most = BacksideCycle {
            lift_mm: points.iter().map(|point| point[2]).fold(0.0, f64::max),
            lifted_part: area(true) / area(false),
            slip_mm: 0.0,
            lock: tray.lock_load(&rest.moved_mm.clone().into()),
        };
        let landed = Landed {
            moved_mm: rest.moved_mm.clone(),
            presses,
            most,
        };
        let before = self.increments.insert(self.increment, landed);
        // Where the same increment has not landed yet, nothing repeats itself.
        self.moved_mm = before.map_or(f64::INFINITY, |before| {
            farthest_mm(&before.moved_mm, &rest.moved_mm)
        });
    }

    /// What the last cycle of every activity comes to.
    pub fn most(&self) -> BacksideCycle {
        let increments = self.increments.values();
        let most = increments.fold(self.before, |most, landed| most.or_more(&landed.most));
        most.or_more(&BacksideCycle {
            slip_mm: self.slip_mm(),
            ..BacksideCycle::default()
        })
    }

    /// The longest way of a point in the present activity's cycle.
    fn slip_mm(&self) -> f64 {
        let mut ways_mm: Vec<f64> = Vec::new();
        let last = self.increments.values().next_back();
        let before = last.into_iter().chain(self.increments.values());
        for (before, landed) in before.zip(self.increments.values()) {
            ways_mm.resize(landed.presses.len(), 0.0);
            let from = before.moved_mm.as_chunks::<3>().0.iter();
            let to = landed.moved_mm.as_chunks::<3>().0;
            for ((way_mm, presses), (from, to)) in
                ways_mm.iter_mut().zip(&landed.presses).zip(from.zip(to))
            {
                if *presses {
                    *way_mm += (to[0] - from[0]).hypot(to[1] - from[1]);
                }
            }
        }
        ways_mm.into_iter().fold(0.0, f64::max)
    }
}
