//! The history of an insert that yields below its surface, for any [`Material`].
//!
//! Plastic strain is an eigenstrain of the elastic insert: its forces on the nodes move the surface (the permanent set,
//! which goes into the gap) and leave stress. Stiffness and compliance stay. To follow an increment, read `flow` and
//! `commit` of [`PlasticInsert`]; `influence` holds the displacements of the interior that these need.

mod influence;
#[cfg(test)]
mod tests;

pub(crate) use influence::Influence;

use std::{collections::BTreeMap, fmt::Debug, ops::Range, sync::Arc};

use condyle_fem::{Material, MaterialPoint, Strain};

use super::{
    complementarity::Candidate,
    elastic_surface::ElasticSurface,
    history::{LoadHistory, NodeLoad, SETTLED_MM, SurfaceLoads, farthest_mm, field, settled},
};
use crate::{
    Vec3,
    contact::{
        contact_patch::ContactPatch,
        law::{PlasticUnderSurface, Regime},
        model::{ContactState, NotBorne, Settled, StateField, TouchedNode},
    },
    geometry::FacesAround,
    number::{Mixing, Turns},
    spatial::RelativeMotion,
};
use influence::ByTile;

/// Gauss points are evaluated in elements whose mean stress uses up this part of the yield stress: within an element stress
/// varies by a tenth or so, and by more at the edge of contact.
const EVALUATED_FROM: f64 = 0.5;
/// Elements whose Gauss points use up this part of the yield stress join the search for the flow: flow nearby can make them
/// yield.
const SEARCHED_FROM: f64 = 0.8;
/// The von Mises stress under a pressure is at most this multiple of its peak: 0.577 for an axisymmetric pressure on an
/// incompressible half-space, but 1 in a pin, and up to 1.1 near its ends.
const MAX_OF_PRESSURE: f64 = 1.25;
/// The flow is found once stress lies on the yield surface within this part of the yield stress.
const ON_SURFACE: f64 = 1e-4;
/// Sweeps after which there is no balance: ten times what was seen where there is one.
const MAX_SWEEPS: usize = 600;
/// Plastic strain beyond which a small-strain solution means nothing.
const MAX_STRAIN: f64 = 0.5;
/// The permanent set is to repeat itself this much more exactly than a motion: an error in it stays for all cycles of an
/// interval.
const MORE_EXACTLY: f64 = 20.0;

const POINTS: usize = 8;

/// The internal variables at the Gauss points of elements that have yielded, by the number of the element.
type Points<P> = BTreeMap<u32, [P; POINTS]>;

/// Accumulated plastic strain at the Gauss points of an element.
type Flow = [f64; POINTS];

/// The eigenstrains at the Gauss points of elements.
pub(crate) type Eigenstrains = BTreeMap<usize, [Strain; POINTS]>;

/// The material of an insert as its law holds it: any [`Material`], without the type of its internal variables.
pub(crate) trait InsertMaterial: Debug + Send + Sync {
    /// Creates the history of an insert of this material, resumed from the stored `state`.
    fn history(&self, surface: Arc<ElasticSurface>, state: &ContactState) -> Box<dyn LoadHistory>;

    /// Returns the plastic strains in a stored state, and their description for results.
    fn under_surface(
        &self,
        surface: &ElasticSurface,
        state: &ContactState,
    ) -> (Eigenstrains, PlasticUnderSurface);
}

impl<M: Material + Clone + Debug + Send + Sync + 'static> InsertMaterial for M {
    fn history(&self, surface: Arc<ElasticSurface>, state: &ContactState) -> Box<dyn LoadHistory> {
        let stored = StoredPlasticity::from_stored(state);
        Box::new(PlasticInsert::new(stored, surface, self.clone()))
    }

    fn under_surface(
        &self,
        surface: &ElasticSurface,
        state: &ContactState,
    ) -> (Eigenstrains, PlasticUnderSurface) {
        let StoredPlasticity {
            points,
            flow_in_cycle,
        } = StoredPlasticity::<M::Point>::from_stored(state);
        let elements = surface.solid.mesh().hexes.len();
        let mut under = PlasticUnderSurface {
            permanent_set_mm: vec![0.0; surface.normal.node_count()],
            plastic_strain: vec![0.0; elements],
            regime: vec![Regime::Elastic; elements],
        };
        for (&element, points) in &points {
            under.plastic_strain[element as usize] = largest_strain(points);
            let flow = flow_in_cycle.get(&element).copied();
            under.regime[element as usize] = Regime::from_flow(flow.unwrap_or_default());
        }
        let strains = eigenstrains(&points);
        if !strains.is_empty() {
            under.permanent_set_mm = surface.along_normals(&surface.moved_by(&[], &strains));
        }
        (strains, under)
    }
}

/// An elastic insert whose material yields.
///
/// The loads of an increment and the flow under them depend on each other. They are solved alternately until the
/// permanent set no longer changes: the loads with the set of the last flow, then the flow under these loads. The loads
/// on the surface are normal ones; friction is neglected in the flow as it is in the gap.
struct PlasticInsert<M: Material> {
    surface: Arc<ElasticSurface>,
    material: M,
    /// The committed state, of all accepted increments.
    committed: Points<M::Point>,
    /// Its displacements of all mesh nodes, mm, and of those of the surface along the inward normals.
    moved_mm: Vec<Vec3>,
    committed_set_mm: Arc<Vec<f64>>,
    /// The trial state of some elements in the present increment, and the set of the surface with it.
    trial: Points<M::Point>,
    set_mm: Vec<f64>,
    turns: Turns,
    /// The flow of each increment, and the permanent set at its end.
    increments: BTreeMap<usize, Increment>,
    /// The number of the present increment.
    increment: usize,
    /// The flow in the cycles of the activities before.
    before: BTreeMap<u32, Flow>,
    moved_in_a_cycle_mm: f64,
    /// The largest part of the yield stress that the residual stress uses up.
    residual_use: f64,
    /// The displacements of mesh nodes by loads and the committed state, mm; current for the elements that are evaluated.
    loaded_mm: Vec<Vec3>,
}

#[derive(Default)]
struct Increment {
    flows: Vec<(u32, Flow)>,
    set_mm: Option<Arc<Vec<f64>>>,
}

impl<M: Material> PlasticInsert<M> {
    fn new(stored: StoredPlasticity<M::Point>, surface: Arc<ElasticSurface>, material: M) -> Self {
        let nodes = surface.solid.mesh().nodes.len();
        let surface_nodes = surface.normal.node_count();
        let mut insert = Self {
            material,
            moved_mm: vec![Vec3::zeros(); nodes],
            committed_set_mm: Arc::new(vec![0.0; surface_nodes]),
            set_mm: vec![0.0; surface_nodes],
            turns: Turns::default(),
            committed: stored.points,
            trial: Points::new(),
            increments: BTreeMap::new(),
            increment: 0,
            before: BTreeMap::new(),
            moved_in_a_cycle_mm: 0.0,
            residual_use: 0.0,
            loaded_mm: vec![Vec3::zeros(); nodes],
            surface,
        };
        insert.update_residual();
        insert
    }

    /// Finds the flow under loads, and returns how far that moves the surface from the trial, mm.
    ///
    /// `peak_mpa` is the highest pressure of the loads, `near` are the nodes of the surface whose displacement is needed.
    fn flow(
        &mut self,
        loads: &[NodeLoad],
        peak_mpa: f64,
        near: impl Iterator<Item = u32>,
        around: &FacesAround,
    ) -> Result<f64, NotBorne> {
        // The von Mises stress of a sum is at most the sum of the von Mises stresses: without a peak high enough nothing
        // yields, and nothing has to be evaluated.
        // Hardening only raises the yield stress: the initial one is a lower bound.
        let by_load = MAX_OF_PRESSURE * peak_mpa / self.material.initial_yield_stress();
        if self.trial.is_empty() && self.residual_use + by_load <= 1.0 {
            return Ok(0.0);
        }
        let evaluated = self.evaluated(loads, around);
        let searched = self.searched(&evaluated);
        self.trial.retain(|element, _| searched.contains(element));
        if searched.is_empty() && self.set_mm == *self.committed_set_mm {
            return Ok(0.0);
        }
        let forces = match self.sweep(&searched) {
            Ok(forces) => forces,
            Err(not_borne) => {
                // Too large a turn: try a set nearer to the last one under whose loads there was a balance, if any.
                self.set_mm = self.turns.nearer().ok_or(not_borne)?;
                self.trial.clear();
                return Ok(f64::INFINITY);
            }
        };
        // Only the set near the contact is needed while the step is solved; committing computes it everywhere.
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

    fn commit(&mut self) {
        let mut changed = false;
        for (element, points) in std::mem::take(&mut self.trial) {
            let before = self.committed_points(element);
            // Elements that were only near the flow are tried, too, and do not change.
            if points != before {
                let flow = |p: usize| points[p].accumulated() - before[p].accumulated();
                let flow = (element, std::array::from_fn(flow));
                let increment = self.increments.entry(self.increment);
                increment.or_default().flows.push(flow);
                changed = true;
            }
            if points.iter().any(|point| point.accumulated() > 0.0) {
                self.committed.insert(element, points);
            }
        }
        if changed {
            self.update_residual();
        }
        self.reject();
    }

    /// Returns the state from which the next contact resumes.
    fn into_stored(self) -> StoredPlasticity<M::Point> {
        let most = |flow: Flow| flow.into_iter().fold(0.0, f64::max);
        let flows = self.flow_in_cycle().into_iter();
        StoredPlasticity {
            flow_in_cycle: flows.map(|(element, flow)| (element, most(flow))).collect(),
            points: self.committed,
        }
    }

    /// Returns the plastic strain accumulated in the last cycle of every activity, by elements.
    fn flow_in_cycle(&self) -> BTreeMap<u32, Flow> {
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

    fn committed_points(&self, element: u32) -> [M::Point; POINTS] {
        self.committed.get(&element).copied().unwrap_or_default()
    }

    /// Updates the displacements by the committed plastic strains, and the residual stress.
    fn update_residual(&mut self) {
        if self.committed.is_empty() {
            return;
        }
        let strains = eigenstrains(&self.committed);
        self.moved_mm = self.surface.moved_by(&[], &strains);
        let set_mm = self.surface.along_normals(&self.moved_mm);
        self.set_mm.clone_from(&set_mm);
        self.committed_set_mm = Arc::new(set_mm);
        let (solid, influence) = (&self.surface.solid, self.surface.influence());
        let yield_mpa = self.material.initial_yield_stress();
        let use_of = |element: usize| {
            let nodes = solid.mesh().hexes[element].map(|node| self.moved_mm[node as usize]);
            let committed = self.committed.get(&(element as u32));
            committed.map_or_else(
                || {
                    // Elements without plastic strain are judged by their mean stress, with the same margin as under load.
                    let mean = solid.element_mean(element);
                    let mean = mean.stress(&nodes, &Strain::default());
                    mean.von_mises() / (EVALUATED_FROM * yield_mpa)
                },
                |committed| {
                    let own = influence.element(solid, element as u32);
                    own.use_of_yield(&self.material, &nodes, committed)
                },
            )
        };
        let uses = (0..solid.mesh().hexes.len()).map(use_of);
        self.residual_use = uses.fold(0.0, f64::max);
    }

    /// Returns the elements whose Gauss points are to be evaluated, and moves their nodes by the loads: those that have
    /// yielded, wherever they are, and those below the contact and around it whose mean stress is near yield.
    fn evaluated(&mut self, loads: &[NodeLoad], around: &FacesAround) -> Vec<u32> {
        let mut is_near = vec![false; self.set_mm.len()];
        for &(node, _) in loads {
            is_near[node as usize] = true;
            for &other in around.of(node as usize).as_flattened() {
                is_near[other as usize] = true;
            }
        }
        let stacks = self.surface.influence().stacks.iter().zip(&is_near);
        let below = stacks.filter(|(_, is_near)| **is_near);
        let mut below: Vec<u32> = below.flat_map(|(stack, _)| stack).copied().collect();
        below.extend(self.committed.keys());
        below.sort_unstable();
        below.dedup();
        self.load_nodes(loads, &below);
        let yield_mpa = self.material.initial_yield_stress();
        let is_near_yield = |element: &u32| {
            let mean = self.surface.solid.element_mean(*element as usize);
            let nodes = self.nodes_of(*element, &ByTile::new());
            self.committed.contains_key(element)
                || mean.stress(&nodes, &Strain::default()).von_mises() > EVALUATED_FROM * yield_mpa
        };
        below.into_iter().filter(is_near_yield).collect()
    }

    /// Computes the displacements of the nodes of elements by loads and the committed state.
    fn load_nodes(&mut self, loads: &[NodeLoad], elements: &[u32]) {
        let surface = Arc::clone(&self.surface);
        let mut is_needed = vec![false; self.loaded_mm.len()];
        for &element in elements {
            for node in surface.solid.mesh().hexes[element as usize] {
                is_needed[node as usize] = true;
            }
        }
        let by_loads = surface.moved_below(loads.iter().map(|&(node, _)| node));
        let pairs = by_loads.iter().zip(loads);
        let pairs: Vec<(&[f32], f64)> = pairs.map(|(by, (_, load_n))| (*by, *load_n)).collect();
        // Only the nodes of evaluated elements: all nodes would take far longer. Neighbours are summed together.
        let mut start = 0;
        let same = |one: &u32, next: &u32| is_needed[*one as usize] == is_needed[*next as usize];
        for nodes in surface.influence().nodes.chunk_by(same) {
            let places = 3 * start..3 * (start + nodes.len());
            start += nodes.len();
            if is_needed[nodes[0] as usize] {
                let sums = sum_of(&pairs, places);
                for (&node, sum) in nodes.iter().zip(sums.as_chunks::<3>().0) {
                    let residual = self.moved_mm[node as usize];
                    self.loaded_mm[node as usize] = residual + Vec3::from(*sum);
                }
            }
        }
    }

    /// Returns the displacements of the nodes of an element, with `more_mm` of some.
    fn nodes_of(&self, element: u32, more_mm: &ByTile) -> [Vec3; 8] {
        let hex = self.surface.solid.mesh().hexes[element as usize];
        let influence = self.surface.influence();
        hex.map(|node| self.loaded_mm[node as usize] + influence.of_node(more_mm, node))
    }

    /// Returns the elements that flow, flowed in the trial state, or are near it; none if none flows.
    fn searched(&self, evaluated: &[u32]) -> Vec<u32> {
        let (solid, influence) = (&self.surface.solid, self.surface.influence());
        let mut flows = !self.trial.is_empty();
        let mut searched = Vec::new();
        for &element in evaluated {
            let nodes = self.nodes_of(element, &ByTile::new());
            let before = self.committed_points(element);
            let own = influence.element(solid, element);
            let used = own.use_of_yield(&self.material, &nodes, &before);
            flows |= used > 1.0;
            if used > SEARCHED_FROM || self.trial.contains_key(&element) {
                searched.push(element);
            }
        }
        if flows { searched } else { Vec::new() }
    }

    /// Finds the flow of elements, and returns its forces by the tiles of mesh nodes.
    ///
    /// The displacements due to the flow and the flow due to the displacements are solved alternately, accelerated by
    /// Anderson mixing of the plastic strains.
    fn sweep(&mut self, elements: &[u32]) -> Result<ByTile, NotBorne> {
        let hexes = &self.surface.solid.mesh().hexes;
        let nodes = elements.iter().flat_map(|&element| hexes[element as usize]);
        let mut tiles: Vec<u32> = nodes
            .map(|node| self.surface.influence().tile_of(node))
            .collect();
        tiles.sort_unstable();
        tiles.dedup();
        let shear_modulus = self.material.elastic().shear_modulus();
        // The plastic strain by which stress misses the yield surface: a strain moves the equivalent stress by 3 G.
        let allowed = ON_SURFACE * self.material.initial_yield_stress() / (3.0 * shear_modulus);
        for &element in elements {
            let before = self.committed_points(element);
            self.trial.entry(element).or_insert(before);
        }
        let (mut mixing, mut tried) = (Mixing::default(), self.strains(elements));
        for _ in 0..MAX_SWEEPS {
            let moved_mm = self.surface.influence().moved(&self.forces(), &tiles);
            let mut changed: f64 = 0.0;
            for &element in elements {
                changed = changed.max(self.flow_element(element, &moved_mm));
            }
            if changed <= allowed {
                return Ok(self.forces());
            }
            if !changed.is_finite() || self.largest_strain() > MAX_STRAIN {
                break;
            }
            tried = mixing.next(&tried, &self.strains(elements), 1.0);
            let mut strains = tried.as_chunks().0.iter();
            for element in elements {
                let points = self.trial.get_mut(element).into_iter().flatten();
                for (point, strain) in points.zip(&mut strains) {
                    point.set_eigenstrain(Strain(*strain));
                }
            }
        }
        Err(NotBorne::Flattened {
            plastic_strain: self.largest_strain(),
        })
    }

    /// Returns the plastic strains of elements in the trial state, one after the other.
    fn strains(&self, elements: &[u32]) -> Vec<f64> {
        let points = elements.iter().flat_map(|element| &self.trial[element]);
        points.flat_map(|point| point.eigenstrain().0).collect()
    }

    /// Updates the flow of an element whose nodes are displaced by the flow around it, and returns how far that is from the
    /// plastic strain tried.
    fn flow_element(&mut self, element: u32, moved_mm: &ByTile) -> f64 {
        let (solid, before) = (&self.surface.solid, self.committed_points(element));
        let trial = self.trial[&element];
        let nodes = self.nodes_of(element, moved_mm);
        let own = self.surface.influence().element(solid, element);
        let flowed = own.flow(&self.material, &nodes, [&trial, &before]);
        let apart = flowed.iter().zip(&trial);
        let apart = apart
            .map(|(flowed, trial)| {
                let change = flowed.eigenstrain().less(&trial.eigenstrain());
                change.equivalent()
            })
            .fold(0.0, f64::max);
        self.trial.insert(element, flowed);
        apart
    }

    /// Returns the forces of the flow in the present increment.
    fn forces(&self) -> ByTile {
        let (solid, influence) = (&self.surface.solid, self.surface.influence());
        let mut forces = ByTile::new();
        for (&element, points) in &self.trial {
            let before = self.committed_points(element);
            if *points == before {
                continue;
            }
            let flow: [Strain; POINTS] =
                std::array::from_fn(|p| points[p].eigenstrain().less(&before[p].eigenstrain()));
            let own = influence.element(solid, element).forces(&flow);
            for (&node, force) in solid.mesh().hexes[element as usize].iter().zip(&own) {
                influence.add_force(&mut forces, node, force);
            }
        }
        forces
    }

    /// Adds the displacements of surface nodes along their inward normals by forces inside, by reciprocity: a force moves a
    /// surface node as far as a unit load there moves the node of the force.
    fn add_set(&self, forces: &ByTile, near: impl Iterator<Item = u32>, set_mm: &mut [f64]) {
        let influence = self.surface.influence();
        let mut tiles: Vec<u32> = near.map(|node| self.surface.normal.tile_of(node)).collect();
        tiles.sort_unstable();
        tiles.dedup();
        // In the order of memory: each row is read once from start to end.
        let nodes = influence.nodes.iter().enumerate();
        let loaded = nodes.map(|(place, &node)| (place, influence.of_node(forces, node)));
        let loaded = loaded.filter(|(_, force)| *force != Vec3::zeros());
        let loaded: Vec<(usize, Vec3)> = loaded.collect();
        let nodes = tiles.iter();
        let nodes = nodes.flat_map(|&tile| self.surface.nodes_of_tile(tile as usize));
        let nodes = nodes.copied();
        for (node, by) in nodes.clone().zip(self.surface.moved_below(nodes)) {
            let by = by.as_chunks::<3>().0;
            let parts = loaded.iter();
            let parts =
                parts.map(|&(place, force)| force.dot(&Vec3::from(by[place].map(f64::from))));
            set_mm[node as usize] += parts.sum::<f64>();
        }
    }

    fn largest_strain(&self) -> f64 {
        self.trial.values().map(largest_strain).fold(0.0, f64::max)
    }
}

impl<M: Material> LoadHistory for PlasticInsert<M> {
    fn begin_cycle(&mut self) {
        self.before = self.flow_in_cycle();
        self.increments.clear();
    }

    fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
        self.increments.entry(increment).or_default().flows.clear();
    }

    fn displace(&mut self, candidates: &mut [Candidate]) {
        for candidate in candidates {
            candidate.displace(self.set_mm[candidate.node as usize]);
        }
    }

    fn settle(&mut self, under: &SurfaceLoads<'_>) -> Result<Settled, NotBorne> {
        let around = under.bodies.insert.faces_around();
        let moved_mm = self.flow(under.loads, under.peak_mpa(), under.near(), around)?;
        Ok(settled(moved_mm > SETTLED_MM))
    }

    fn accept(&mut self, _: &RelativeMotion, _: &ContactPatch<'_>) {
        self.commit();
    }

    fn reject(&mut self) {
        self.turns = Turns::default();
        self.trial.clear();
        self.set_mm.clone_from(&self.committed_set_mm);
    }

    fn evaluate(&mut self, increment: usize, _: &mut [TouchedNode]) {
        let set_mm = &self.committed_set_mm;
        let end = self.increments.entry(increment).or_default();
        let moved_mm = match end.set_mm.replace(Arc::clone(set_mm)) {
            // In the first cycle nothing has repeated itself yet.
            None => f64::INFINITY,
            Some(before) if Arc::ptr_eq(&before, set_mm) => 0.0,
            Some(before) => farthest_mm(&before, set_mm),
        };
        self.moved_in_a_cycle_mm = MORE_EXACTLY * moved_mm;
    }

    fn moved_in_a_cycle_mm(&self) -> f64 {
        self.moved_in_a_cycle_mm
    }

    fn into_fields(self: Box<Self>) -> Vec<StateField> {
        self.into_stored().field().into_iter().collect()
    }
}

/// Returns the sum of rows of displacements, each times its load.
fn sum_of(by_loads: &[(&[f32], f64)], places: Range<usize>) -> Vec<f64> {
    let mut sums = vec![0.0; places.len()];
    for (by, load_n) in by_loads {
        for (sum, &by) in sums.iter_mut().zip(&by[places.clone()]) {
            *sum += f64::from(by) * load_n;
        }
    }
    sums
}

fn eigenstrains<P: MaterialPoint>(points: &Points<P>) -> Eigenstrains {
    let strains = |points: &[P; POINTS]| points.map(|point| point.eigenstrain());
    points
        .iter()
        .map(|(&element, points)| (element as usize, strains(points)))
        .collect()
}

fn largest_strain<P: MaterialPoint>(points: &[P; POINTS]) -> f64 {
    points.iter().map(P::accumulated).fold(0.0, f64::max)
}

/// The plastic state that is stored: internal variables, and the flow in the last cycle.
///
/// Its field has of every element that has yielded its number, the largest flow of its Gauss points in the last cycle, and
/// of each point the numbers of its internal variables.
#[derive(Clone, Debug, PartialEq)]
struct StoredPlasticity<P: MaterialPoint> {
    points: Points<P>,
    /// The largest strain that accumulated at a Gauss point of each element in the last cycle.
    flow_in_cycle: BTreeMap<u32, f64>,
}

impl<P: MaterialPoint> StoredPlasticity<P> {
    /// Reads the field of a contact's state; empty if there is none.
    fn from_stored(state: &ContactState) -> Self {
        let (mut points, mut flow_in_cycle) = (Points::new(), BTreeMap::new());
        let values = state.named(P::FIELD).next();
        let values = values.map_or(&[][..], |values| values);
        for numbers in values.chunks_exact(2 + POINTS * P::NUMBERS) {
            let element = numbers[0] as u32;
            let point = |p: usize| P::from_numbers(&numbers[2 + p * P::NUMBERS..][..P::NUMBERS]);
            points.insert(element, std::array::from_fn(point));
            flow_in_cycle.insert(element, numbers[1]);
        }
        Self {
            points,
            flow_in_cycle,
        }
    }

    /// Returns the field; none if nothing has yielded.
    fn field(&self) -> Option<StateField> {
        let values = self.points.iter().flat_map(|(element, points)| {
            let flow = self.flow_in_cycle.get(element).copied().unwrap_or_default();
            let own = [f64::from(*element), flow];
            own.into_iter().chain(points.iter().flat_map(P::numbers))
        });
        (!self.points.is_empty()).then(|| field(P::FIELD, values.collect()))
    }
}
