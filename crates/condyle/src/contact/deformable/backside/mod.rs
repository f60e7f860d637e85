//! A backside that rests on its tray: each place of it presses and sticks there or slips, or lifts.
//!
//! Its flat part rests (`floor`). Where it moves is told at points (`tray_points`) of a `grid`, whose motions give stiffness and compliance as those of a solid with
//! moved supports (`tray`). Under the loads on the surface it comes to rest by Signorini's and Coulomb's conditions
//! (`rest`). How it gets there from increment to increment is `insert`; what stays is `memory`, and what a cycle came to
//! `cycle`.

mod floor;
mod rest;
#[cfg(test)]
mod tests;
mod tray;

pub(crate) use floor::Floor;
pub(crate) use rest::{BACKSIDE_CYCLE_FIELD, BACKSIDE_FIELD, BacksideMemory, rest};
pub(crate) use tray::Tray;

use std::sync::Arc;

use nalgebra::DVector;

use super::{
    complementarity::Candidate,
    compliance::Compliance,
    elastic_surface::ElasticSurface,
    history::{LoadHistory, LoadedPatch, NodeLoad, SETTLED_MM, SurfaceLoads},
};
use crate::{
    contact::model::{NotBorne, StateField, Tipped, TouchedNode},
    number::Turns,
    spatial::RelativeMotion,
};
use rest::{CycleOfRest, Rest};

/// An elastic insert whose backside rests on its tray with friction.
///
/// The loads of an increment and the rest of the backside under them depend on each other: the loads are those with the
/// backside as it was tried last, the rest is that under the loads found last, in turns until the surface stays. The
/// first try goes on from the two increments before.
pub(crate) struct RestingInsert {
    surface: Arc<Compliance<ElasticSurface>>,
    tray: Arc<Tray>,
    friction: f64,
    /// The position of the backside after the last accepted increment, and its last step.
    left_mm: Vec<f64>,
    went_mm: Option<Vec<f64>>,
    /// The trial position, and the displacement of each node of the surface under it, as far as was asked.
    tried_mm: Vec<f64>,
    set_mm: Vec<Option<f64>>,
    /// The equilibrium under the loads found last, if any.
    found: Option<Rest>,
    searched_mm: DVector<f64>,
    turns: Turns,
    cycle: CycleOfRest,
    memory: BacksideMemory,
    /// The number of the activity, once a cycle has begun.
    activity: Option<usize>,
}

impl RestingInsert {
    /// An insert that goes on from what is remembered.
    pub fn after(
        memory: BacksideMemory,
        surface: Arc<Compliance<ElasticSurface>>,
        tray: Arc<Tray>,
        friction: f64,
    ) -> Self {
        let left_mm = memory.start(0, tray.freedoms());
        Self {
            set_mm: vec![None; surface.node_count()],
            searched_mm: left_mm.clone().into(),
            tried_mm: left_mm.clone(),
            left_mm,
            went_mm: None,
            found: None,
            turns: Turns::default(),
            cycle: CycleOfRest::default(),
            activity: None,
            memory,
            surface,
            tray,
            friction,
        }
    }

    /// Returns the displacement of a node of the surface by the backside, mm.
    pub fn set_mm(&mut self, node: u32) -> f64 {
        if let Some(set_mm) = self.set_mm[node as usize] {
            return set_mm;
        }
        let tile = self.surface.tile_of(node);
        let rows = self.surface.source.by_tray(&self.tray, tile as usize);
        let nodes = self.surface.source.nodes_of_tile(tile as usize);
        let rows = rows.chunks_exact(self.tried_mm.len());
        for (&node, row) in nodes.iter().zip(rows) {
            self.set_mm[node as usize] = Some(product(row, &self.tried_mm));
        }
        self.set_mm[node as usize].unwrap_or_default()
    }

    /// Finds the rest under loads; how far that moves nodes of the surface from where they were tried to be, mm.
    ///
    /// # Errors
    /// Loads under which the insert tips off its tray.
    pub fn rest(
        &mut self,
        loads: &[NodeLoad],
        near: impl Iterator<Item = u32>,
    ) -> Result<f64, Tipped> {
        let forces_n = self.surface.source.forces_on_tray(&self.tray, loads);
        let stuck_mm = &self.left_mm;
        let found = rest(
            &self.tray,
            self.friction,
            stuck_mm,
            &forces_n,
            &self.searched_mm,
        )?;
        let tried: Vec<(u32, f64)> = near.map(|node| (node, self.set_mm(node))).collect();
        let tried_mm = std::mem::replace(&mut self.tried_mm, found.moved_mm.clone());
        self.set_mm.fill(None);
        let moved = tried
            .into_iter()
            .map(|(node, tried_mm)| (self.set_mm(node) - tried_mm).abs());
        let moved_mm = moved.fold(0.0, f64::max);
        if moved_mm > SETTLED_MM {
            self.tried_mm = self.turns.next(&tried_mm, &found.moved_mm);
            self.set_mm.fill(None);
        }
        self.searched_mm.clone_from(&found.searched_mm);
        self.found = Some(found);
        Ok(moved_mm)
    }

    /// Tries the backside where it was left, or as much farther as it went.
    fn try_anew(&mut self, way_mm: Option<&[f64]>) {
        self.tried_mm.clone_from(&self.left_mm);
        for (tried, way) in self.tried_mm.iter_mut().zip(way_mm.unwrap_or_default()) {
            *tried += way;
        }
        self.set_mm.fill(None);
        self.turns = Turns::default();
    }
}

impl LoadHistory for RestingInsert {
    fn begin_cycle(&mut self) {
        let next = self.activity.map_or(0, |activity| {
            self.memory.keep(activity, self.left_mm.clone());
            activity + 1
        });
        self.activity = Some(next);
        self.cycle.begin();
        self.left_mm = self.memory.start(next, self.tray.freedoms());
        self.searched_mm = self.left_mm.clone().into();
        self.reject();
    }

    fn begin_increment(&mut self, increment: usize) {
        self.cycle.begin_increment(increment);
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

    fn settle(&mut self, under: &SurfaceLoads<'_>) -> Result<f64, NotBorne> {
        Ok(self.rest(under.loads, under.near())?)
    }

    fn accept(&mut self, _: &RelativeMotion, _: &LoadedPatch<'_>) {
        if let Some(found) = &self.found {
            let way = found.moved_mm.iter().zip(&self.left_mm);
            let way: Vec<f64> = way.map(|(to, from)| to - from).collect();
            self.left_mm.clone_from(&found.moved_mm);
            // A first way has nothing to go on from: it may begin anywhere.
            let goes_on = self.went_mm.is_some();
            self.try_anew(goes_on.then_some(way.as_slice()));
            self.went_mm = Some(way);
        }
    }

    fn reject(&mut self) {
        self.found = None;
        self.went_mm = None;
        self.try_anew(None);
    }

    fn evaluate(&mut self, _: &mut [TouchedNode]) {
        if let Some(found) = &self.found {
            self.cycle.end_increment(&self.tray, found);
        }
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        self.cycle.moved_mm
    }

    fn into_fields(mut self: Box<Self>) -> Vec<StateField> {
        let left_mm = std::mem::take(&mut self.left_mm);
        self.memory.keep(self.activity.unwrap_or(0), left_mm);
        self.memory.last_cycles = self.cycle.most();
        self.memory.into_fields().collect()
    }
}

fn product(row: &[f64], numbers: &[f64]) -> f64 {
    row.iter().zip(numbers).map(|(a, b)| a * b).sum()
}
