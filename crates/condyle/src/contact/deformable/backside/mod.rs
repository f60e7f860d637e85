//! The history of a backside that rests on its tray: each place of it is in contact and sticks or slips, or lifts off.
//!
//! The flat part of the backside rests (`floor`). Its motion is that of points on a grid; their stiffness, and the
//! equilibrium under given loads by Signorini's and Coulomb's conditions, are in `tray`. To follow an increment, read
//! `settle`, `accept` and `evaluate` of [`RestingInsert`].

mod floor;
#[cfg(test)]
mod tests;
mod tray;

pub(crate) use floor::Floor;
pub(crate) use tray::Tray;

use std::{collections::BTreeMap, sync::Arc};

use nalgebra::DVector;

use super::{
    complementarity::Candidate,
    elastic_surface::ElasticSurface,
    history::{ByActivity, LoadHistory, SETTLED_MM, SurfaceLoads, farthest_mm, field, settled},
};
use crate::{
    contact::{
        contact_patch::ContactPatch,
        law::BacksideAtRest,
        model::{ContactState, NotBorne, Settled, StateField, TouchedNode},
    },
    number::Turns,
    spatial::RelativeMotion,
};
use tray::{AT_REST_MM, Rest};

/// The fields of the contact's state with the motion of the backside's points in which each activity left them, three
/// numbers a point: along their own directions, anterior, lateral, off the tray.
const MOVED_FIELD: &str = "backside_moved_mm";

/// The field with the extremes of the last cycles, the numbers of [`BacksideAtRest`].
const CYCLE_FIELD: &str = "backside_lift_mm_lifted_part_slip_mm_lock_n_lock_nmm";

/// While the loads still change, the equilibrium is found within this, mm: a tenth of the agreement of loads and backside.
const ROUGHLY_MM: f64 = 0.1 * SETTLED_MM;
/// Number of equilibria of a step that may be rough, more than most steps need: where the insert hardly rests, as in swing, a
/// small residual can be far from the equilibrium, and loads and backside do not settle.
const MAX_ROUGH_TURNS: usize = 4;

/// An elastic insert whose backside rests on its tray with friction.
///
/// The loads of an increment and the equilibrium of the backside depend on each other. They are solved alternately
/// until the surface no longer moves: the loads with the backside in its trial position, then the equilibrium under
/// these loads. The first trial extrapolates the two previous increments.
pub(crate) struct RestingInsert {
    surface: Arc<ElasticSurface>,
    tray: Arc<Tray>,
    friction: f64,
    /// The position of the backside after the last accepted step, and the change by that step.
    left_mm: Vec<f64>,
    went_mm: Option<Vec<f64>>,
    /// The trial position, and the displacement of each node of the surface under it, as far as it was needed.
    tried_mm: Vec<f64>,
    set_mm: Vec<Option<f64>>,
    /// The equilibrium under the loads found last, if any, and the start of the search for the next.
    found: Option<Rest>,
    searched_mm: DVector<f64>,
    turns: Turns,
    /// The number of equilibria found in this step.
    turn: usize,
    activities: ByActivity<Vec<f64>>,
    /// The end of each increment of the cycle, kept until the same increment of the next cycle.
    ends: BTreeMap<usize, IncrementEnd>,
    /// The extremes of the cycles of the activities before.
    before: BacksideAtRest,
    moved_in_a_cycle_mm: f64,
}

struct IncrementEnd {
    moved_mm: Vec<f64>,
    in_contact: Vec<bool>,
    /// All but the slip.
    most: BacksideAtRest,
}

impl RestingInsert {
    pub fn new(
        state: &ContactState,
        surface: Arc<ElasticSurface>,
        tray: Arc<Tray>,
        friction: f64,
    ) -> Self {
        let activities = stored_positions(state);
        let left_mm = of_points(activities.start_of(0), &tray);
        Self {
            set_mm: vec![None; surface.normal.node_count()],
            searched_mm: left_mm.clone().into(),
            tried_mm: left_mm.clone(),
            left_mm,
            went_mm: None,
            found: None,
            turns: Turns::default(),
            turn: 0,
            activities,
            ends: BTreeMap::new(),
            before: BacksideAtRest::default(),
            moved_in_a_cycle_mm: 0.0,
            surface,
            tray,
            friction,
        }
    }

    /// Returns the displacement of a node of the surface by the backside in its trial position, mm.
    fn set_mm(&mut self, node: u32) -> f64 {
        if let Some(set_mm) = self.set_mm[node as usize] {
            return set_mm;
        }
        let tile = self.surface.normal.tile_of(node) as usize;
        let rows = self.tray.of_tile(&self.surface.loads, tile);
        let nodes = self.surface.nodes_of_tile(tile);
        let mut sums_mm = vec![0.0; nodes.len()];
        for (row, tried) in rows.chunks_exact(nodes.len()).zip(&self.tried_mm) {
            for (sum_mm, by) in sums_mm.iter_mut().zip(row) {
                *sum_mm += by * tried;
            }
        }
        for (&node, sum_mm) in nodes.iter().zip(sums_mm) {
            self.set_mm[node as usize] = Some(sum_mm);
        }
        self.set_mm[node as usize].unwrap_or_default()
    }

    /// Resets the trial to the last position of the backside, displaced by `way_mm`.
    fn reset_trial(&mut self, way_mm: Option<&[f64]>) {
        self.tried_mm.clone_from(&self.left_mm);
        for (tried, way) in self.tried_mm.iter_mut().zip(way_mm.unwrap_or_default()) {
            *tried += way;
        }
        self.set_mm.fill(None);
        self.turns = Turns::default();
        self.turn = 0;
    }

    fn most(&self) -> BacksideAtRest {
        let most = self.ends.values().map(|end| &end.most);
        let most = most.fold(self.before, or_more);
        let slip_mm = self.slip_mm();
        let slip = BacksideAtRest {
            slip_mm,
            ..BacksideAtRest::default()
        };
        or_more(most, &slip)
    }

    /// Returns the longest slip of a point along the tray in the present activity's cycle, there and back.
    fn slip_mm(&self) -> f64 {
        let mut slips_mm: Vec<f64> = Vec::new();
        // The cycle is closed: the first increment follows the last.
        let before = self.ends.values().next_back().into_iter();
        for (before, end) in before.chain(self.ends.values()).zip(self.ends.values()) {
            slips_mm.resize(end.in_contact.len(), 0.0);
            let from = before.moved_mm.as_chunks::<3>().0.iter();
            let to = end.moved_mm.as_chunks::<3>().0;
            for ((slip_mm, in_contact), (from, to)) in
                slips_mm.iter_mut().zip(&end.in_contact).zip(from.zip(to))
            {
                if *in_contact {
                    *slip_mm += (to[0] - from[0]).hypot(to[1] - from[1]);
                }
            }
        }
        slips_mm.into_iter().fold(0.0, f64::max)
    }
}

impl LoadHistory for RestingInsert {
    fn begin_cycle(&mut self) {
        let left_mm = std::mem::take(&mut self.left_mm);
        self.left_mm = of_points(self.activities.begin_cycle(left_mm), &self.tray);
        self.before = self.most();
        self.ends.clear();
        self.searched_mm = self.left_mm.clone().into();
        self.reject();
    }

    fn displace(&mut self, candidates: &mut [Candidate]) {
        for candidate in candidates {
            candidate.displace(self.set_mm(candidate.node));
        }
    }

    fn lift_mm(&self) -> f64 {
        let points = self.tried_mm.as_chunks::<3>().0.iter();
        points.map(|point| point[2]).fold(0.0, f64::max)
    }

    /// Finds the equilibrium under the loads; they agree if it moves no node near the contact too far from the trial.
    fn settle(&mut self, under: &SurfaceLoads<'_>) -> Result<Settled, NotBorne> {
        let forces_n = self.surface.forces_on_tray(&self.tray, under.loads);
        let (stuck_mm, from_mm) = (&self.left_mm, &self.searched_mm);
        let is_rough = self.turn < MAX_ROUGH_TURNS;
        let within_mm = if is_rough { ROUGHLY_MM } else { AT_REST_MM };
        let mut found =
            self.tray
                .rest_within(within_mm, self.friction, stuck_mm, &forces_n, from_mm)?;
        self.turn += 1;
        let tried = under.near().map(|node| (node, self.set_mm(node)));
        let tried: Vec<(u32, f64)> = tried.collect();
        let tried_mm = std::mem::replace(&mut self.tried_mm, found.moved_mm.clone());
        self.set_mm.fill(None);
        // Once a node has moved too far, the displacements of the others need not be computed.
        let mut tried = tried.into_iter();
        let moves = tried.any(|(node, tried_mm)| (self.set_mm(node) - tried_mm).abs() > SETTLED_MM);
        if moves {
            self.tried_mm = self.turns.next(&tried_mm, &found.moved_mm);
            self.set_mm.fill(None);
        } else if is_rough {
            let (stuck_mm, from_mm) = (&self.left_mm, &found.searched_mm);
            found = self
                .tray
                .rest(self.friction, stuck_mm, &forces_n, from_mm)?;
        }
        self.searched_mm.clone_from(&found.searched_mm);
        self.found = Some(found);
        Ok(settled(moves))
    }

    fn accept(&mut self, _: &RelativeMotion, _: &ContactPatch<'_>) {
        if let Some(found) = &self.found {
            let way = found.moved_mm.iter().zip(&self.left_mm);
            let way: Vec<f64> = way.map(|(to, from)| to - from).collect();
            self.left_mm.clone_from(&found.moved_mm);
            // The first step is not extrapolated: it may have started far from equilibrium.
            let extrapolates = self.went_mm.is_some();
            self.reset_trial(extrapolates.then_some(way.as_slice()));
            self.went_mm = Some(way);
        }
    }

    fn reject(&mut self) {
        self.found = None;
        self.went_mm = None;
        self.reset_trial(None);
    }

    fn evaluate(&mut self, increment: usize, _: &mut [TouchedNode]) {
        let Some(rest) = &self.found else {
            return;
        };
        let pushes = rest.pushes_n.as_chunks::<3>().0.iter();
        let in_contact: Vec<bool> = pushes.map(|push| push[2] > 0.0).collect();
        let area = |lifted: bool| -> f64 {
            let points = self.tray.points.iter().zip(&in_contact);
            let counted = points.filter(|(_, in_contact)| !(lifted && **in_contact));
            counted.map(|(point, _)| point.area_mm2).sum()
        };
        let [lock_force_n, lock_moment_nmm] = self.tray.lock_load(&rest.moved_mm.clone().into());
        let points = rest.moved_mm.as_chunks::<3>().0.iter();
        let most = BacksideAtRest {
            lift_mm: points.map(|point| point[2]).fold(0.0, f64::max),
            lifted_part: area(true) / area(false),
            slip_mm: 0.0,
            lock_force_n,
            lock_moment_nmm,
        };
        let moved_mm = rest.moved_mm.clone();
        let end = IncrementEnd {
            moved_mm,
            in_contact,
            most,
        };
        let before = self.ends.insert(increment, end);
        // In the first cycle nothing has repeated itself yet.
        self.moved_in_a_cycle_mm = before.map_or(f64::INFINITY, |before| {
            farthest_mm(&before.moved_mm, &rest.moved_mm)
        });
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        self.moved_in_a_cycle_mm
    }

    fn into_fields(self: Box<Self>) -> Vec<StateField> {
        let cycle = field(CYCLE_FIELD, numbers(&self.most()).to_vec());
        let left = self.activities.finish(self.left_mm).into_iter();
        let left = left.map(|moved_mm| field(MOVED_FIELD, moved_mm));
        left.chain([cycle]).collect()
    }
}

/// Reads the positions in which activities left the backside from a contact's state.
fn stored_positions(state: &ContactState) -> ByActivity<Vec<f64>> {
    ByActivity::new(state.named(MOVED_FIELD).cloned().collect())
}

/// Returns the position of the points of a tray: as stored, or on the tray as made if that is of other points or of none.
fn of_points(stored_mm: Vec<f64>, tray: &Tray) -> Vec<f64> {
    if stored_mm.len() == tray.freedoms() {
        stored_mm
    } else {
        vec![0.0; tray.freedoms()]
    }
}

/// Returns the stored position of the backside at the end of an activity, and the stored extremes of the last cycles.
pub(crate) fn stored(
    state: &ContactState,
    activity: usize,
    tray: &Tray,
) -> (Vec<f64>, BacksideAtRest) {
    let cycle = state.named(CYCLE_FIELD).next();
    let cycle = cycle.and_then(|values| values.first_chunk());
    let left_mm = of_points(stored_positions(state).start_of(activity), tray);
    (
        left_mm,
        cycle.map_or_else(BacksideAtRest::default, from_numbers),
    )
}

fn or_more(one: BacksideAtRest, other: &BacksideAtRest) -> BacksideAtRest {
    let (own, others) = (numbers(&one), numbers(other));
    from_numbers(&std::array::from_fn(|i| own[i].max(others[i])))
}

fn numbers(most: &BacksideAtRest) -> [f64; 5] {
    [
        most.lift_mm,
        most.lifted_part,
        most.slip_mm,
        most.lock_force_n,
        most.lock_moment_nmm,
    ]
}

fn from_numbers(numbers: &[f64; 5]) -> BacksideAtRest {
    let [lift_mm, lifted_part, slip_mm, lock_force_n, lock_moment_nmm] = *numbers;
    BacksideAtRest {
        lift_mm,
        lifted_part,
        slip_mm,
        lock_force_n,
        lock_moment_nmm,
    }
}
