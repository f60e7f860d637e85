//! The states of a deformable insert that depend on the load history: one interface for yield, friction and backside.

use crate::{
    contact::{
        contact_patch::ContactPatch,
        law::Bodies,
        model::{NotBorne, Settled, StateField, TouchedNode},
    },
    spatial::{
        Mat6, RelativeMotion, Wrench,
        body::{Counterface, Insert},
    },
};

use super::complementarity::Candidate;

/// A load on a node of the surface along the inward normal, N.
pub(crate) type NodeLoad = (u32, f64);

/// Loads and histories agree once they move the surface by no more than this, mm: about 1e-5 of its deflection under
/// load, far too little to change a wear depth. A smaller value only adds iterations.
pub(crate) const SETTLED_MM: f64 = 1e-5;

/// A part of the insert's state that depends on the load history: plastic strain, friction that sticks, the position of
/// a backside that rests.
///
/// A history has a committed state and a trial state. An increment is solved with the trial state; `settle` updates
/// that under the loads found, until loads and state agree, and `accept` commits it. The next contact resumes from
/// `into_fields`.
pub(crate) trait LoadHistory {
    /// Begins the cycle of the next activity.
    fn begin_cycle(&mut self);

    fn begin_increment(&mut self, _increment: usize) {}

    /// Subtracts from the overclosures of the candidates the displacement of the surface in the trial state.
    fn displace(&mut self, _candidates: &mut [Candidate]) {}

    /// Returns how much nearer to the counterface the trial state can bring the surface, mm.
    fn lift_mm(&self) -> f64 {
        0.0
    }

    /// Returns the wrench on the insert of the loads along its surface about the counterface's origin, in the counterface frame.
    fn respond(&mut self, _patch: &ContactPatch<'_>) -> Option<Wrench<Insert, Counterface>> {
        None
    }

    /// Returns the derivative of that wrench by a motion of the counterface.
    fn tangent(&self) -> Option<Mat6> {
        None
    }

    /// Updates the trial state under the loads of the last response; it agrees with them if that moves the surface by no more
    /// than [`SETTLED_MM`].
    ///
    /// # Errors
    /// The insert cannot bear the load.
    fn settle(&mut self, _loads: &SurfaceLoads<'_>) -> Result<Settled, NotBorne> {
        Ok(Settled::Yes)
    }

    /// Commits the trial state at the end of a step, near the last response.
    fn accept(&mut self, motion: &RelativeMotion, patch: &ContactPatch<'_>);

    fn reject(&mut self) {}

    /// Ends an increment of the cycle, and adds the contribution of the history to the nodes in contact.
    fn evaluate(&mut self, increment: usize, touched: &mut [TouchedNode]);

    /// See [`ContactModel::moved_in_a_cycle_mm`](crate::contact::ContactModel::moved_in_a_cycle_mm).
    fn moved_in_a_cycle_mm(&self) -> f64;

    /// Returns the fields of the contact's state from which the next contact resumes.
    fn into_fields(self: Box<Self>) -> Vec<StateField>;
}

pub(crate) fn field(name: &str, values: Vec<f64>) -> StateField {
    StateField {
        name: name.to_owned(),
        values,
    }
}

/// The state that every activity left: the cycles of an activity resume where its last cycle ended.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ByActivity<S> {
    left: Vec<S>,
    /// The number of the present activity, once a cycle has begun.
    present: Option<usize>,
}

impl<S: Clone + Default> ByActivity<S> {
    pub fn new(left: Vec<S>) -> Self {
        Self {
            left,
            present: None,
        }
    }

    /// Returns the state at the start of an activity: the default where it has not begun yet.
    pub fn start_of(&self, activity: usize) -> S {
        self.left.get(activity).cloned().unwrap_or_default()
    }

    /// Begins the cycle of the next activity and returns the state at its start; the activity before ends in `state`.
    pub fn begin_cycle(&mut self, state: S) -> S {
        let next = self.present.map_or(0, |activity| activity + 1);
        if self.present.is_some() {
            self.keep(state);
        }
        self.present = Some(next);
        self.start_of(next)
    }

    /// Returns the states of all activities, of which the present one ends in `state`.
    pub fn finish(mut self, state: S) -> Vec<S> {
        self.keep(state);
        self.left
    }

    fn keep(&mut self, state: S) {
        let activity = self.present.unwrap_or(0);
        let count = self.left.len().max(activity + 1);
        self.left.resize_with(count, S::default);
        self.left[activity] = state;
    }
}

/// Returns whether loads and history agree, of which the history moves the surface too far or not.
pub(crate) fn settled(moves_too_far: bool) -> Settled {
    if moves_too_far {
        Settled::RespondAgain
    } else {
        Settled::Yes
    }
}

pub(crate) fn farthest_mm(one_mm: &[f64], other_mm: &[f64]) -> f64 {
    let apart = one_mm.iter().zip(other_mm).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}

/// The loads of the last response along the inward normals.
pub(crate) struct SurfaceLoads<'l> {
    pub bodies: Bodies<'l>,
    pub loads: &'l [NodeLoad],
    pub candidates: &'l [Candidate],
}

impl SurfaceLoads<'_> {
    pub fn peak_mpa(&self) -> f64 {
        let shares = &self.bodies.surface.shares;
        let pressures = self.loads.iter();
        pressures
            .map(|&(node, load_n)| load_n / shares[node as usize].area_mm2)
            .fold(0.0, f64::max)
    }

    pub fn near(&self) -> impl Iterator<Item = u32> {
        self.candidates.iter().map(|candidate| candidate.node)
    }
}
