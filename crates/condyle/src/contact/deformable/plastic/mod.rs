//! The insert that yields below its surface.
//!
//! Plastic strain is an eigenstrain of the elastic insert: its forces on the nodes move the surface (the permanent
//! set, which goes into the gap) and leave stress. Stiffness and compliance stay. `influence` keeps what loads and
//! plastic strains move below the surface, `insert` finds the flow under the loads of an increment (led by Anderson's mixing), `cycle` tells
//! what flows in a cycle that repeats, and `memory` is what the next contact goes on from.

mod cycle;
mod influence;
#[cfg(test)]
mod tests;

pub(crate) use cycle::{CycleOfFlow, PLASTIC_FIELD, PlasticMemory, farthest_mm};
pub(crate) use influence::Influence;

use std::{collections::BTreeMap, sync::Arc};

use condyle_fem::{ElasticPlastic, ElasticSolid, Hardening, PlasticPoint, Strain};

use super::{
    complementarity::Candidate,
    compliance::Compliance,
    elastic_surface::ElasticSurface,
    history::{LoadHistory, LoadedPatch, NodeLoad, SETTLED_MM, SurfaceLoads},
};
use crate::{
    Vec3,
    contact::model::{Flattened, NotBorne, StateField, TouchedNode},
    geometry::FacesAround,
    number::{Mixing, Turns},
    spatial::RelativeMotion,
};
use cycle::{POINTS, Points};
use influence::{ByTile, product};

/// Gauss points are looked at in elements whose mean stress uses up this part of the yield stress: within an element
/// stress varies by a tenth or so, and by more at the edge of contact.
const LOOKED_AT: f64 = 0.5;
/// Elements whose Gauss points use up this part of the yield stress are taken along in the search for the flow.
const TAKEN_ALONG: f64 = 0.8;
/// No pressure causes more than this part of its peak as von Mises stress: 0.577 where a half-space keeps its volume
/// and the pressure is symmetric about an axis, with what other shapes may add.
const MAX_OF_PRESSURE: f64 = 0.8;
/// The flow is found once stress lies on the yield surface within this part of the yield stress.
const ON_SURFACE: f64 = 1e-4;
/// Sweeps after which there is no balance: ten times what was seen where there is.
const MAX_SWEEPS: usize = 600;
/// Plastic strain beyond which small strains say nothing any more.
const MAX_STRAIN: f64 = 0.5;

/// An elastic insert whose material yields (von Mises).
///
/// The loads of an increment and the flow under them depend on each other: the loads are those with the permanent set
/// of the flow found last, the flow is that under the loads found last, in turns until the set stays. The loads on the
/// surface are normal ones; friction counts as little in the flow as it does in the gap.
pub(crate) struct PlasticInsert {
    surface: Arc<Compliance<ElasticSurface>>,
    material: ElasticPlastic,
    /// The committed state, of all accepted increments.
    committed: Points,
    /// The displacements of all mesh nodes by it, mm, and of those of the surface along the inward normals.
    moved_mm: Vec<Vec3>,
    committed_set_mm: Arc<Vec<f64>>,
    /// The trial state of some elements in the present increment, and the set of the surface with it.
    trial: Points,
    set_mm: Vec<f64>,
    turns: Turns,
    pub cycle: CycleOfFlow,
    /// The largest part of the yield stress that stress without load uses up.
    residual_use: f64,
    /// The displacements of mesh nodes by loads and the committed state, mm.
    loaded_mm: Vec<Vec3>,
}

impl PlasticInsert {
    /// An insert that goes on from what is remembered.
    pub fn after(
        remembered: PlasticMemory,
        surface: Arc<Compliance<ElasticSurface>>,
        hardening: Hardening,
    ) -> Self {
        let elastic = surface.source.solid().elastic();
        let nodes = surface.source.solid().mesh().nodes.len();
        let mut insert = Self {
            material: ElasticPlastic { elastic, hardening },
            moved_mm: vec![Vec3::zeros(); nodes],
            committed_set_mm: Arc::new(vec![0.0; surface.node_count()]),
            set_mm: vec![0.0; surface.node_count()],
            turns: Turns::default(),
            committed: remembered.points,
            trial: Points::new(),
            cycle: CycleOfFlow::default(),
            residual_use: 0.0,
            loaded_mm: vec![Vec3::zeros(); nodes],
            surface,
        };
        insert.move_by_committed();
        insert
    }

    /// Finds the flow under loads; how far that moves the surface from where it was, mm.
    ///
    /// `peak_mpa` is the highest pressure of the loads, `near` are the nodes of the surface that are asked for.
    pub fn flow(
        &mut self,
        loads: &[NodeLoad],
        peak_mpa: f64,
        near: impl Iterator<Item = u32>,
        around: &FacesAround,
    ) -> Result<f64, Flattened> {
        if self.trial.is_empty() && !self.may_flow(peak_mpa) {
            return Ok(0.0);
        }
        let looked_at = self.looked_at(loads, around);
        let taken = self.taken_along(&looked_at);
        self.trial.retain(|element, _| taken.contains(element));
        if taken.is_empty() && self.set_mm == *self.committed_set_mm {
            return Ok(0.0);
        }
        let forces = match self.sweep(&taken) {
            Ok(forces) => forces,
            Err(flattened) => return self.turn_back().ok_or(flattened),
        };
        let mut found_mm = Vec::clone(&self.committed_set_mm);
        self.add_set(&forces, near, &mut found_mm);
        let changed_mm = farthest_mm(&found_mm, &self.set_mm);
        self.set_mm = if changed_mm <= SETTLED_MM {
            found_mm
        } else {
            self.turns.next(&self.set_mm, &found_mm)
        };
        Ok(changed_mm)
    }

    /// Tries a set nearer to that of the turns before, under whose loads there was a balance; none where there was none.
    fn turn_back(&mut self) -> Option<f64> {
        self.set_mm = self.turns.nearer()?;
        self.trial.clear();
        Some(f64::INFINITY)
    }

    /// Commits the trial state.
    fn commit(&mut self) {
        let before = |element: &u32| self.committed.get(element).copied().unwrap_or_default();
        let mut changed = false;
        for (element, points) in &self.trial {
            let before = before(element);
            if *points != before {
                let flow = |p: usize| points[p].accumulated - before[p].accumulated;
                self.cycle.add(*element, std::array::from_fn(flow));
                changed = true;
            }
        }
        let trial = std::mem::take(&mut self.trial);
        let flowed = |points: &[PlasticPoint; POINTS]| points.iter().any(|p| p.accumulated > 0.0);
        self.committed
            .extend(trial.into_iter().filter(|(_, points)| flowed(points)));
        if changed {
            self.move_by_committed();
        }
        self.reject();
    }

    /// Returns the state from which the next contact resumes.
    pub fn into_memory(self) -> PlasticMemory {
        let most = |flow: [f64; POINTS]| flow.into_iter().fold(0.0, f64::max);
        let flows = self.cycle.flow().into_iter();
        PlasticMemory {
            points: self.committed,
            flow_in_cycle: flows.map(|(element, flow)| (element, most(flow))).collect(),
        }
    }

    /// Returns whether a pressure can cause flow: the von Mises stress of a sum is at most the sum of the von Mises stresses.
    fn may_flow(&self, peak_mpa: f64) -> bool {
        let by_load = MAX_OF_PRESSURE * peak_mpa / self.material.hardening.yield_stress(0.0);
        self.residual_use + by_load > 1.0
    }

    fn solid(&self) -> &ElasticSolid {
        self.surface.source.solid()
    }

    fn influence(&self) -> &Influence {
        self.surface.source.influence()
    }

    fn before(&self, element: u32) -> [PlasticPoint; POINTS] {
        self.committed.get(&element).copied().unwrap_or_default()
    }

    /// Moves nodes and surface by the plastic strains that count.
    fn move_by_committed(&mut self) {
        if self.committed.is_empty() {
            return;
        }
        self.moved_mm = self
            .surface
            .source
            .moved_by(&[], &strains_of(&self.committed));
        let set_mm = self.surface.source.along_normals(&self.moved_mm);
        self.set_mm.clone_from(&set_mm);
        self.committed_set_mm = Arc::new(set_mm);
        self.residual_use = self.residual_use();
    }

    /// The largest part of the yield stress that the stress left by plastic strains uses up.
    fn residual_use(&self) -> f64 {
        let (solid, influence) = (self.solid(), self.influence());
        let yield_mpa = self.material.hardening.yield_stress(0.0);
        let use_of = |element: usize| {
            let nodes = solid.mesh().hexes[element].map(|node| self.moved_mm[node as usize]);
            let before = self.committed.get(&(element as u32));
            before.map_or_else(
                || {
                    let mean = influence.means[element].stress(&nodes, &Strain::default());
                    mean.von_mises() / (LOOKED_AT * yield_mpa)
                },
                |before| {
                    let own = influence.element(solid, element as u32);
                    own.use_of_yield(solid, &self.material, &nodes, before)
                },
            )
        };
        (0..influence.means.len()).map(use_of).fold(0.0, f64::max)
    }

    /// The elements that have yielded, wherever they are, and those below the nodes that press and those around them
    /// whose mean stress is near yield.
    ///
    /// Takes along how far their nodes are moved.
    fn looked_at(&mut self, loads: &[NodeLoad], around: &FacesAround) -> Vec<u32> {
        let mut below = self.below(loads, around);
        below.extend(self.committed.keys());
        below.sort_unstable();
        below.dedup();
        self.load_nodes(loads, &below);
        let influence = self.influence();
        let yield_mpa = self.material.hardening.yield_stress(0.0);
        let is_near_yield = |element: &u32| {
            let mean = &influence.means[*element as usize];
            let nodes = self.nodes_of(*element, &ByTile::new());
            self.committed.contains_key(element)
                || mean.stress(&nodes, &Strain::default()).von_mises() > LOOKED_AT * yield_mpa
        };
        below.into_iter().filter(is_near_yield).collect()
    }

    /// The elements below nodes and those around them.
    fn below(&self, loads: &[NodeLoad], around: &FacesAround) -> Vec<u32> {
        let mut is_near = vec![false; self.set_mm.len()];
        for &(node, _) in loads {
            is_near[node as usize] = true;
            for &other in around.of(node as usize).as_flattened() {
                is_near[other as usize] = true;
            }
        }
        let stacks = self.influence().stacks.iter().zip(&is_near);
        let below = stacks.filter(|(_, is_near)| **is_near);
        below.flat_map(|(stack, _)| stack).copied().collect()
    }

    /// Computes the displacements of the nodes of elements by loads and the committed state.
    fn load_nodes(&mut self, loads: &[NodeLoad], elements: &[u32]) {
        let hexes = Arc::clone(&self.solid().mesh().hexes);
        let mut is_asked = vec![false; self.loaded_mm.len()];
        for &element in elements {
            for node in hexes[element as usize] {
                is_asked[node as usize] = true;
            }
        }
        let by_tile = self.surface.source.by_tile(loads);
        let tiles = by_tile.iter();
        let rows: Vec<(&[f32], &Vec<f64>)> = tiles
            .map(|(&tile, loads)| (self.surface.source.moved_below(tile as usize), loads))
            .collect();
        let asked = (0..is_asked.len()).filter(|&node| is_asked[node]);
        let loaded: Vec<(usize, Vec3)> = asked
            .map(|node| (node, self.moved_mm[node] + moved(node, &rows)))
            .collect();
        for (node, loaded_mm) in loaded {
            self.loaded_mm[node] = loaded_mm;
        }
    }

    /// Displacements of the nodes of an element, with more of some.
    fn nodes_of(&self, element: u32, more_mm: &ByTile) -> [Vec3; 8] {
        let hex = self.solid().mesh().hexes[element as usize];
        let influence = self.influence();
        hex.map(|node| self.loaded_mm[node as usize] + influence.of_node(more_mm, node))
    }

    /// Elements that flow, did so in what was tried, or are near it; nothing where none flows.
    fn taken_along(&self, looked_at: &[u32]) -> Vec<u32> {
        let (solid, influence) = (self.solid(), self.influence());
        let mut flows = !self.trial.is_empty();
        let mut taken = Vec::new();
        for &element in looked_at {
            let (nodes, before) = (self.nodes_of(element, &ByTile::new()), self.before(element));
            let own = influence.element(solid, element);
            let used = own.use_of_yield(solid, &self.material, &nodes, &before);
            flows |= used > 1.0;
            if used > TAKEN_ALONG || self.trial.contains_key(&element) {
                taken.push(element);
            }
        }
        if flows { taken } else { Vec::new() }
    }

    /// Finds the flow of elements; the forces of what flows, by the tiles of mesh nodes.
    fn sweep(&mut self, taken: &[u32]) -> Result<ByTile, Flattened> {
        let tiles = self.tiles_of(taken);
        let allowed = ON_SURFACE * self.material.hardening.yield_stress(0.0)
            / (3.0 * self.material.elastic.shear_modulus());
        for &element in taken {
            let before = self.before(element);
            self.trial.entry(element).or_insert(before);
        }
        let (mut mixing, mut tried) = (Mixing::default(), self.strains(taken));
        for _ in 0..MAX_SWEEPS {
            let forces = self.forces();
            let moved_mm = self.influence().moved(self.solid(), &forces, &tiles);
            let mut changed: f64 = 0.0;
            for &element in taken {
                changed = changed.max(self.flow_element(element, &moved_mm));
            }
            if changed <= allowed {
                return Ok(self.forces());
            }
            if !changed.is_finite() || self.largest_strain() > MAX_STRAIN {
                break;
            }
            tried = mixing.next(&tried, &self.strains(taken), 1.0);
            self.try_strains(taken, &tried);
        }
        Err(Flattened {
            plastic_strain: self.largest_strain(),
        })
    }

    /// Plastic strains that are tried in elements, one after the other.
    fn strains(&self, elements: &[u32]) -> Vec<f64> {
        let points = elements.iter().flat_map(|element| &self.trial[element]);
        points.flat_map(|point| point.strain.0).collect()
    }

    /// Tries plastic strains in elements.
    fn try_strains(&mut self, elements: &[u32], strains: &[f64]) {
        let mut strains = strains.as_chunks().0.iter();
        for element in elements {
            let points = self.trial.get_mut(element).into_iter().flatten();
            for (point, strain) in points.zip(&mut strains) {
                point.strain = Strain(*strain);
            }
        }
    }

    /// Lets an element flow with its nodes moved by what flows around it; how far that is from the plastic strain tried.
    fn flow_element(&mut self, element: u32, moved_mm: &ByTile) -> f64 {
        let (solid, before) = (self.solid(), self.before(element));
        let trial = self.trial[&element];
        let nodes = self.nodes_of(element, moved_mm);
        let own = self.influence().element(solid, element);
        let flowed = own.flow(solid, &self.material, &nodes, [&trial, &before]);
        let apart = flowed.iter().zip(&trial);
        let apart = apart
            .map(|(flowed, trial)| flowed.strain.less(&trial.strain).equivalent())
            .fold(0.0, f64::max);
        self.trial.insert(element, flowed);
        apart
    }

    /// Forces of what flows in the present increment.
    fn forces(&self) -> ByTile {
        let (solid, influence) = (self.solid(), self.influence());
        let mut forces = ByTile::new();
        for (&element, points) in &self.trial {
            let before = self.before(element);
            if *points == before {
                continue;
            }
            let flow: [Strain; POINTS] =
                std::array::from_fn(|p| points[p].strain.less(&before[p].strain));
            let own = influence.element(solid, element).forces(solid, &flow);
            for (&node, force) in solid.mesh().hexes[element as usize].iter().zip(&own) {
                influence.add_force(&mut forces, node, force);
            }
        }
        forces
    }

    /// Tiles of the mesh nodes of elements, ascending.
    fn tiles_of(&self, elements: &[u32]) -> Vec<u32> {
        let hexes = &self.solid().mesh().hexes;
        let nodes = elements.iter().flat_map(|&element| hexes[element as usize]);
        let mut tiles: Vec<u32> = nodes.map(|node| self.influence().tile_of(node)).collect();
        tiles.sort_unstable();
        tiles.dedup();
        tiles
    }

    /// Adds how far forces inside move nodes of the surface along their inward normals.
    fn add_set(&self, forces: &ByTile, near: impl Iterator<Item = u32>, set_mm: &mut [f64]) {
        let (source, influence) = (&self.surface.source, self.influence());
        let mut tiles: Vec<u32> = near.map(|node| self.surface.tile_of(node)).collect();
        tiles.sort_unstable();
        tiles.dedup();
        let mut loaded: BTreeMap<u32, Vec3> = BTreeMap::new();
        for &node in forces.keys().flat_map(|&tile| influence.nodes(tile)) {
            loaded.insert(node, influence.of_node(forces, node));
        }
        for tile in tiles {
            let nodes = source.nodes_of_tile(tile as usize);
            let rows = source.moved_below(tile as usize);
            for (&node, force) in &loaded {
                let own = &rows[3 * node as usize * nodes.len()..][..3 * nodes.len()];
                for (row, force) in own.chunks_exact(nodes.len()).zip(force) {
                    for (&node, &by) in nodes.iter().zip(row) {
                        set_mm[node as usize] += f64::from(by) * force;
                    }
                }
            }
        }
    }

    fn largest_strain(&self) -> f64 {
        let points = self.trial.values().flatten();
        points.map(|point| point.accumulated).fold(0.0, f64::max)
    }
}

impl LoadHistory for PlasticInsert {
    fn begin_cycle(&mut self) {
        self.cycle.begin();
    }

    fn begin_increment(&mut self, increment: usize) {
        self.cycle.begin_increment(increment);
    }

    fn displace(&mut self, candidates: &mut [Candidate]) {
        for candidate in candidates {
            candidate.displace(self.set_mm[candidate.node as usize]);
        }
    }

    fn settle(&mut self, under: &SurfaceLoads<'_>) -> Result<f64, NotBorne> {
        let around = under.bodies.insert.faces_around();
        Ok(self.flow(under.loads, under.peak_mpa(), under.near(), around)?)
    }

    fn accept(&mut self, _: &RelativeMotion, _: &LoadedPatch<'_>) {
        self.commit();
    }

    fn reject(&mut self) {
        self.turns = Turns::default();
        self.trial.clear();
        self.set_mm.clone_from(&self.committed_set_mm);
    }

    fn evaluate(&mut self, _: &mut [TouchedNode]) {
        self.cycle.end_increment(&self.committed_set_mm);
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        self.cycle.moved_mm()
    }

    fn into_fields(self: Box<Self>) -> Vec<StateField> {
        self.into_memory().field().into_iter().collect()
    }
}

/// Plastic strains of elements.
pub(crate) fn strains_of(points: &Points) -> BTreeMap<usize, [Strain; POINTS]> {
    let strains = points.iter();
    strains
        .map(|(&element, points)| (element as usize, points.map(|point| point.strain)))
        .collect()
}

/// Returns the displacement of a mesh node by loads on tiles of the surface, mm.
fn moved(node: usize, rows: &[(&[f32], &Vec<f64>)]) -> Vec3 {
    let mut moved = Vec3::zeros();
    for (rows, loads) in rows {
        let own = &rows[3 * node * loads.len()..][..3 * loads.len()];
        for (moved, row) in moved.iter_mut().zip(own.chunks_exact(loads.len())) {
            *moved += product(row, loads);
        }
    }
    moved
}
