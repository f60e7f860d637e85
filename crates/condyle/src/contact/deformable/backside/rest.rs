//! The equilibrium of a backside on its tray, its results over a cycle, and its stored state.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::tray::{LockLoad, Tray};
use crate::{
    contact::{
        deformable::plastic::farthest_mm,
        model::{ContactState, StateField, Tipped},
    },
    number::Mixing,
};

/// The backside rests once what it does under what pushes it and what it may do agree within this, mm: a hundredth of
/// what loads and backside have to agree within.
const AT_REST_MM: f64 = 1e-7;
/// Steps after which there is no rest: ten times what was seen where there is.
const MAX_STEPS: usize = 5000;
/// A backside that is this far off its tray has nothing that holds it, mm.
const TIPPED_MM: f64 = 10.0;

/// A backside at rest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rest {
    /// Motion of every point along its own directions, anterior, lateral, off the tray, mm.
    pub moved_mm: Vec<f64>,
    /// The force of the tray on each, N.
    pub pushes_n: Vec<f64>,
    /// The start of the search for the next equilibrium.
    pub searched_mm: DVector<f64>,
}

/// The rest of a backside under forces b of the surface on its points, N, of which each stuck last where `stuck_mm` says.
///
/// Every point lifts without force or presses, and sticks or slips the way that friction points against:
///
/// $$ q_n \ge 0, \quad R_n \ge 0, \quad q_n R_n = 0, \qquad |R_t| \le \mu R_n, \quad
/// R_t = -\mu R_n \frac{q_t - q_t^0}{|q_t - q_t^0|} \quad \text{where it slips}, \qquad R = S q - b. $$
///
/// Douglas and Rachford's splitting [eckstein-bertsekas1992]: what the conditions allow a point alone that is pulled by a
/// spring, and what the whole does with the springs of all, in turns, led by Anderson's mixing.
///
/// # Errors
/// A load under which the insert tips off its tray.
pub(crate) fn rest(
    tray: &Tray,
    friction: f64,
    stuck_mm: &[f64],
    forces_n: &DVector<f64>,
    searched_mm: &DVector<f64>,
) -> Result<Rest, Tipped> {
    let mut searched = searched_mm.clone();
    let mut mixing = Mixing::default();
    for _ in 0..MAX_STEPS {
        let allowed = allowed(tray, friction, stuck_mm, &searched);
        let mirrored = &allowed * 2.0 - &searched;
        let apart = tray.pulled(forces_n, &mirrored) - &allowed;
        let apart_mm = apart.amax();
        if apart_mm <= AT_REST_MM {
            let pulls = tray
                .stiffness_of_search
                .iter()
                .zip(allowed.iter().zip(searched.iter()));
            return Ok(Rest {
                pushes_n: pulls.map(|(own, (at, from))| own * (at - from)).collect(),
                moved_mm: allowed.as_slice().to_vec(),
                searched_mm: searched,
            });
        }
        if !allowed.amax().is_finite() || allowed.amax() > TIPPED_MM {
            break;
        }
        let image = &searched + apart;
        searched = mixing
            .next(searched.as_slice(), image.as_slice(), 1.0)
            .into();
    }
    let moved_mm = allowed(tray, friction, stuck_mm, &searched).amax();
    Err(Tipped { moved_mm })
}

/// Projects every point, pulled to a place by the stiffness of the search, onto its contact conditions.
fn allowed(tray: &Tray, friction: f64, stuck_mm: &[f64], pulled_to: &DVector<f64>) -> DVector<f64> {
    let points = pulled_to.as_slice().as_chunks::<3>().0;
    let stuck = stuck_mm.as_chunks::<3>().0;
    let allowed = points.iter().zip(stuck);
    let allowed = allowed.flat_map(|(to, stuck)| allowed_alone(friction, *stuck, *to));
    DVector::from_iterator(tray.freedoms(), allowed)
}

fn allowed_alone(friction: f64, stuck: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    let [x, z, off] = to;
    if off > 0.0 {
        return to;
    }
    let slip = [x - stuck[0], z - stuck[1]];
    let wanted = slip[0].hypot(slip[1]);
    let held = -friction * off;
    let part = if wanted <= held {
        0.0
    } else {
        1.0 - held / wanted
    };
    [stuck[0] + part * slip[0], stuck[1] + part * slip[1], 0.0]
}

/// The extremes of the backside's motion in the last cycle of any activity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BacksideCycle {
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
    pub fn from_numbers(numbers: &[f64; 5]) -> Self {
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
        Self::from_numbers(&std::array::from_fn(|i| own[i].max(others[i])))
    }
}

/// The state at the end of each increment when it was solved last.
#[derive(Default)]
pub(crate) struct CycleOfRest {
    /// The increments of the activity that is being solved.
    increments: BTreeMap<usize, IncrementEnd>,
    increment: usize,
    /// The result of the cycles of the activities before.
    before: BacksideCycle,
    /// The distance of the backside from its place at the same increment a cycle before, mm.
    pub moved_mm: f64,
}

struct IncrementEnd {
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
    pub fn end_increment(&mut self, tray: &Tray, rest: &Rest) {
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
        let landed = IncrementEnd {
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

    /// Returns the extremes over the last cycle of every activity.
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

/// The fields of the contact's state with where each activity left the points of the backside, three numbers each:
/// along their own directions, anterior, lateral, off the tray.
pub(crate) const BACKSIDE_FIELD: &str = "backside_moved_mm";

/// The field with what the last cycles came to: see [`BacksideCycle`].
pub(crate) const BACKSIDE_CYCLE_FIELD: &str =
    "backside_lift_mm_lifted_part_slip_mm_lock_n_lock_nmm";

/// The position in which every activity left the backside, and the extremes of the last cycles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BacksideMemory {
    activities: Vec<Vec<f64>>,
    pub last_cycles: BacksideCycle,
}

impl BacksideMemory {
    /// Reads the fields of a contact's state.
    pub fn from_state(state: &ContactState) -> Self {
        let named = |name| state.fields.iter().filter(move |field| field.name == name);
        let cycle = named(BACKSIDE_CYCLE_FIELD).find_map(|field| field.values.first_chunk());
        Self {
            activities: named(BACKSIDE_FIELD)
                .map(|field| field.values.clone())
                .collect(),
            last_cycles: cycle.map_or_else(BacksideCycle::default, BacksideCycle::from_numbers),
        }
    }

    /// Returns the position at the start of an activity: where it ended, or on the tray as made where it has not begun, or
    /// began on other points.
    pub fn start(&self, activity: usize, freedoms: usize) -> Vec<f64> {
        let left = self.activities.get(activity);
        let left = left.filter(|left| left.len() == freedoms);
        left.cloned().unwrap_or_else(|| vec![0.0; freedoms])
    }

    /// An activity has left the backside there.
    pub fn keep(&mut self, activity: usize, moved_mm: Vec<f64>) {
        let count = self.activities.len().max(activity + 1);
        self.activities.resize_with(count, Vec::new);
        self.activities[activity] = moved_mm;
    }

    /// The fields of the state.
    pub fn into_fields(self) -> impl Iterator<Item = StateField> {
        let named = |name: &str, values| StateField {
            name: name.to_owned(),
            values,
        };
        let cycle = named(BACKSIDE_CYCLE_FIELD, self.last_cycles.numbers().to_vec());
        let activities = self.activities.into_iter();
        let activities = activities.map(move |moved_mm| named(BACKSIDE_FIELD, moved_mm));
        activities.chain([cycle])
    }
}
