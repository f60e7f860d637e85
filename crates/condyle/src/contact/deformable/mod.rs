//! The deformable insert: a rigid femur on an elastic body, without penalty.
//!
//! [`Deformable`] is the law; it makes a `DeformableContact` (`contact`). That takes the gaps of the bodies at rest along
//! the insert's normals and finds the loads under which the bodies just touch (`complementarity`, by the factor of
//! `cholesky` and its updates in `changed_factor`). The deflection of the surface is its `compliance`, computed by finite
//! elements (`elastic_surface`) for the nodes that come near. At the end of an increment `edge_and_peak` finds the part of
//! every share that presses, and the peak pressure.
//!
//! State that depends on what came before is a load history (`history`): the insert may yield below its surface
//! (`plastic`), stick and slip along it (`friction`, `stick_slip`), and rest on its tray (`backside`). Loads and histories
//! are solved in turns, accelerated by Anderson's mixing.

mod backside;
mod changed_factor;
mod cholesky;
mod complementarity;
mod compliance;
mod contact;
mod edge_and_peak;
mod elastic_surface;
mod friction;
mod history;
mod plastic;
mod stick_slip;
#[cfg(test)]
mod tests;

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError},
};

use condyle_fem::{Elastic, Hardening, PlasticPoint, SolidError, Stress};

use super::{
    broad_phase::{BroadPhase, BruteForce, Coherent, Search},
    contact_patch::Coulomb,
    foundation::Foundation,
    law::{
        BacksideAtRest, Bodies, ContactLaw, KnownCompliance, PlasticUnderSurface, Regime,
        UnderSurface,
    },
    model::{ContactMemory, ContactModel, ContactState, StateField},
};
use crate::{Vec3, geometry::Insert};
use backside::{BacksideMemory, Floor, RestingInsert, Tray, rest};
use compliance::Compliance;
use contact::{DeformableContact, FrictionSettings};
use elastic_surface::{ElasticSurface, HeldBy};
use friction::{ElasticFriction, FrictionMemory};
use plastic::{PlasticInsert, PlasticMemory, strains_of};

/// So much of the compliances of inserts is remembered, bytes: of a knee that of the insert and of its coarser twin,
/// unworn and worn.
pub(crate) const MAX_REMEMBERED_BYTES: f64 = 3e8;

/// Coulomb's friction on a deformable insert.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionModel {
    /// It goes with the sliding speed, mu N v / sqrt(v^2 + v0^2), and does not move the surface along itself.
    #[default]
    Regularised,
    /// The surface deflects along itself, and each node sticks or slides: what carries less than mu N does not slide. What
    /// each carries is remembered from increment to increment.
    StickSlip,
}

/// The support of the backside of a deformable insert on its tray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Backside {
    /// It is bonded: it neither lifts nor slips.
    #[default]
    Bonded,
    /// It rests: where it presses it sticks or slips with Coulomb's friction, elsewhere it lifts. The rim that locks it
    /// carries the net force and moment along the tray.
    Resting {
        /// Coulomb's coefficient of friction.
        friction: f64,
        /// Spacing of the points at which its motion is told, mm.
        spacing_mm: f64,
    },
}

/// The law of an elastic insert under a rigid femur.
///
/// Small displacements: the surface deflects along its inward normals by the normal compliance C of the insert,
/// computed by finite elements. The loads N at the nodes hold the bodies just in touch where they press,
///
/// $$ N \ge 0, \quad g + C N \ge 0, \quad N \cdot (g + C N) = 0, $$
///
/// with the gaps g of the bodies at rest: nothing is tuned. Every node's share of the surface presses along the
/// femur's normal and rubs with Coulomb friction, regularised or with stick and slip. Wear goes into the gap; C is that of the insert
/// unworn, and recomputed where an insert has become thinner by more than a twentieth. With a yield stress the insert flows below
/// its surface (von Mises, small strains), and what that leaves of a dent goes into the gap; the stiffness stays.
/// Limits: loads along the surface do not move it along its normal, nor do normal loads along it; a tray that does not give.
/// An insert that rests on its tray neither yields nor sticks and slips on its surface.
#[derive(Debug)]
pub struct Deformable {
    /// The elastic material, MPa.
    pub elastic: Elastic,
    /// Coulomb's coefficient of friction, mu.
    pub friction: f64,
    /// The model of friction: with or without elastic deflection along the surface.
    pub friction_model: FrictionModel,
    /// Speed at which friction has reached 71 % of its full value, v0, mm/s, > 0; of regularised friction.
    pub slip_tolerance_mm_per_s: f64,
    /// The search for the nodes that may touch; no result depends on it.
    pub search: Search,
    /// Motion up to which a sample of the femur is extrapolated, mm; 0 takes every sample anew.
    pub sample_reuse_mm: f64,
    /// The yield stress of the insert, MPa, if it yields.
    pub hardening: Option<Hardening>,
    /// The support of the backside.
    pub(crate) backside: Backside,
    remembered: Arc<KnownSurfaces>,
}

/// Compliances of inserts, the one that was used last at the end; clones of a law share them.
#[derive(Debug, Default)]
struct KnownSurfaces(Mutex<Vec<Arc<Compliance<ElasticSurface>>>>);

impl Clone for Deformable {
    fn clone(&self) -> Self {
        Self {
            remembered: Arc::clone(&self.remembered),
            hardening: self.hardening.clone(),
            ..*self
        }
    }
}

impl Deformable {
    /// The law of an insert that is bonded to its tray, whose stiffness is factored here.
    ///
    /// # Errors
    /// A material or a mesh that is no elastic solid: a part of it is not held by the backside, for instance.
    pub fn new(
        elastic: Elastic,
        friction: f64,
        slip_tolerance_mm_per_s: f64,
        insert: &Insert,
    ) -> Result<Self, SolidError> {
        let backside = Backside::default();
        Self::held(elastic, friction, slip_tolerance_mm_per_s, backside, insert)
    }

    /// The law of an insert whose backside is held so.
    ///
    /// # Errors
    /// As [`Deformable::new`].
    pub fn held(
        elastic: Elastic,
        friction: f64,
        slip_tolerance_mm_per_s: f64,
        backside: Backside,
        insert: &Insert,
    ) -> Result<Self, SolidError> {
        let law = Self {
            elastic,
            friction,
            friction_model: FrictionModel::default(),
            slip_tolerance_mm_per_s,
            search: Search::default(),
            sample_reuse_mm: Foundation::SAMPLE_REUSE_MM,
            hardening: None,
            backside,
            remembered: Arc::default(),
        };
        law.surface(insert, insert.unworn_nodes())?;
        Ok(law)
    }

    /// The same law of an insert whose backside is held so; where it rests on its flat part the stiffness is factored again if
    /// there is more than that.
    ///
    /// # Errors
    /// An insert of which a part is not held by that.
    pub fn with_backside(
        mut self,
        backside: Backside,
        insert: &Insert,
    ) -> Result<Self, SolidError> {
        self.backside = backside;
        self.surface(insert, insert.unworn_nodes())?;
        Ok(self)
    }

    /// Returns the part of an insert's backside, projected onto the tray, that is flat and can rest.
    ///
    /// Faces that lean by less than 15 degrees from straight down, within a quarter of a millimetre of their middle height.
    pub fn flat_part_of_backside(insert: &Insert) -> f64 {
        Floor::from_backside(insert.mesh(), insert.backside_nodes()).part
    }

    /// The surface of an insert with its mesh nodes there: remembered, or recomputed.
    pub(crate) fn surface(
        &self,
        insert: &Insert,
        mesh_nodes: &[Vec3],
    ) -> Result<Arc<Compliance<ElasticSurface>>, SolidError> {
        let held_by = self.held_by();
        let mut remembered = self
            .remembered
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let place = place_of(&remembered, insert, mesh_nodes, held_by);
        let surface = if let Some(place) = place {
            remembered.remove(place)
        } else {
            // Before, so that what goes and what comes are not there at once.
            forget_the_oldest(&mut remembered);
            let surface = ElasticSurface::new(insert, mesh_nodes, self.elastic, held_by)?;
            Arc::new(Compliance::new(surface))
        };
        remembered.push(Arc::clone(&surface));
        Ok(surface)
    }

    /// The surface of an insert with its mesh nodes there, if it is remembered.
    pub(crate) fn remembered(
        &self,
        insert: &Insert,
        mesh_nodes: &[Vec3],
    ) -> Option<Arc<Compliance<ElasticSurface>>> {
        let remembered = self
            .remembered
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let place = place_of(&remembered, insert, mesh_nodes, self.held_by())?;
        Some(Arc::clone(&remembered[place]))
    }

    /// Returns whether anything is known of the compliance of an unworn insert.
    pub fn knows(&self, insert: &Insert) -> bool {
        let surface = self.remembered(insert, insert.unworn_nodes());
        surface
            .is_some_and(|surface| surface.known_count() > 0 || surface.source.known_at_first() > 0)
    }

    /// Takes what another run has found of the compliance of an unworn insert with these elastic constants and this hold of
    /// its backside: it need not be computed again, and no answer depends on it.
    ///
    /// # Errors
    /// A mesh that is no elastic solid.
    pub fn know(&self, insert: &Insert, known: KnownCompliance) -> Result<(), SolidError> {
        let surface = self.surface(insert, insert.unworn_nodes())?;
        surface.source.know(known);
        Ok(())
    }

    fn held_by(&self) -> HeldBy {
        match self.backside {
            Backside::Bonded => HeldBy::Backside,
            Backside::Resting { .. } => HeldBy::Floor,
        }
    }

    pub(crate) fn coulomb(&self) -> Coulomb {
        Coulomb {
            coefficient: self.friction,
            slip_tolerance_mm_per_s: self.slip_tolerance_mm_per_s,
        }
    }
}

/// Returns the place of the surface of an insert with the given mesh nodes.
fn place_of(
    remembered: &[Arc<Compliance<ElasticSurface>>],
    insert: &Insert,
    mesh_nodes: &[Vec3],
    held_by: HeldBy,
) -> Option<usize> {
    let mut remembered = remembered.iter();
    remembered.position(|surface| surface.source.is_of(insert, mesh_nodes, held_by))
}

/// Makes room for one as large as the newest.
fn forget_the_oldest(remembered: &mut Vec<Arc<Compliance<ElasticSurface>>>) {
    let bytes = |surface: &Arc<Compliance<ElasticSurface>>| {
        surface
            .source
            .bytes(surface.known_count() as f64, [1.0, 0.0])
    };
    while let Some(newest) = remembered.last()
        && remembered.iter().map(bytes).sum::<f64>() + bytes(newest) > MAX_REMEMBERED_BYTES
    {
        remembered.remove(0);
    }
}

/// An insert that has become thinner by more than this part somewhere since its compliance was computed gets a
/// new one.
///
/// Wear is in the gap; what the compliance of an insert thinner by 4 % differs by changes the peak pressure by
/// half a percent.
const MAX_THINNER: f64 = 0.05;

/// The field of the contact's state that holds the mesh nodes whose compliance is used, x, y and z of each.
const NODES_FIELD: &str = "compliance_nodes_mm";

/// The fall of the pressure at a node as the node alone recedes, times edge over contact modulus: 1.2 on a
/// half-space where pressure is even over squares, and 1.7 for squares that deflect by turns; more where elements
/// are stiffer than the body.
const ALONE: f64 = 1.9;

/// The memory of an insert and its coarser twin over that of the insert.
const WITH_TWIN: f64 = 1.5;

impl ContactLaw for Deformable {
    /// # Panics
    /// An insert, other than that which the law was made of, that is no elastic solid.
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a> {
        match self.search {
            Search::Coherent => Box::new(self.contact_by::<Coherent>(bodies, memory)),
            Search::BruteForce => Box::new(self.contact_by::<BruteForce>(bodies, memory)),
        }
    }

    /// The stiffness of a node of an elastic half-space: what deflects along with a node alone is no deeper than its
    /// share is wide.
    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64 {
        let ratio = self.elastic.poissons_ratio;
        let contact_modulus_mpa = self.elastic.youngs_modulus / (1.0 - ratio * ratio);
        ALONE * contact_modulus_mpa / insert.unworn_share_mm2(node).sqrt()
    }

    fn memory_bytes(&self, insert: &Insert, nodes_near: f64) -> f64 {
        let along_surface = match self.friction_model {
            FrictionModel::Regularised => 0.0,
            FrictionModel::StickSlip => 2.0,
        };
        let surface = self.surface(insert, insert.unworn_nodes());
        surface.map_or(0.0, |surface| {
            let bytes = surface.source.bytes(nodes_near, [1.0, along_surface]);
            // The coarser twin of the insert, and the insert as it has worn, are kept besides.
            let beside = bytes.min(MAX_REMEMBERED_BYTES);
            let below = self
                .hardening
                .as_ref()
                .map_or(0.0, |_| WITH_TWIN * surface.source.bytes_below(nodes_near));
            let at_backside = match self.backside {
                Backside::Bonded => 0.0,
                Backside::Resting { spacing_mm, .. } => {
                    WITH_TWIN * surface.source.bytes_of_tray(spacing_mm, nodes_near)
                }
            };
            bytes + beside + below + at_backside
        })
    }

    fn under_surface(
        &self,
        insert: &Insert,
        state: &ContactState,
        activity: usize,
        loads: &[(u32, f64)],
    ) -> Option<UnderSurface> {
        let (compliance, state) = self.compliance(insert, state);
        let surface = &compliance.source;
        Some(match self.backside {
            Backside::Bonded => {
                let remembered = self
                    .hardening
                    .as_ref()
                    .map(|_| PlasticMemory::from_state(&state));
                under_surface(surface, remembered, loads)
            }
            Backside::Resting {
                friction,
                spacing_mm,
            } => {
                let (tray, memory) = (surface.tray(spacing_mm), BacksideMemory::from_state(&state));
                above_tray(surface, &tray, friction, &memory, (activity, loads))
            }
        })
    }

    fn known_compliance(&self, insert: &Insert, more_than_pairs: usize) -> Option<KnownCompliance> {
        let surface = self.remembered(insert, insert.unworn_nodes())?;
        let left_pairs = surface.source.known().pairs();
        let more_than_pairs = more_than_pairs.max(surface.source.known_at_first());
        if left_pairs + surface.asked_pairs() <= more_than_pairs {
            return None;
        }
        let left = surface.source.known().clone();
        Some(surface.known_with(left))
    }

    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw> {
        let mut law = self.clone();
        law.slip_tolerance_mm_per_s *= factor;
        Arc::new(law)
    }
}

impl Deformable {
    /// The compliance to use for an insert after a contact has left `state`, and the state to leave.
    fn compliance(
        &self,
        insert: &Insert,
        state: &ContactState,
    ) -> (Arc<Compliance<ElasticSurface>>, ContactState) {
        let used = used_nodes(insert, state);
        let now = &insert.mesh().nodes;
        if is_much_thinner(insert, &used)
            && let Ok(renewed) = self.surface(insert, now)
        {
            return (renewed, state_of(now, state));
        }
        let surface = self.surface(insert, &used);
        // A case checks its insert as it is built.
        let surface = surface.expect("the insert is an elastic solid");
        (surface, state.clone())
    }
}

impl Deformable {
    /// The contact of bodies, with a broad phase `B`.
    fn contact_by<'a, B: BroadPhase>(
        &self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> DeformableContact<'a, B> {
        let (compliance, state) = self.compliance(bodies.insert, &memory.state);
        let plastic = self.plastic(&state, &compliance);
        let resting = self.resting(&state, &compliance);
        let (friction, coulomb) = match self.friction_model {
            FrictionModel::Regularised => (None, self.coulomb()),
            FrictionModel::StickSlip => {
                let tangential = Arc::clone(compliance.source.tangential());
                let memory = FrictionMemory::from_state(&state);
                let friction =
                    ElasticFriction::after(memory, self.friction, bodies.surface, tangential);
                let without = Coulomb {
                    coefficient: 0.0,
                    ..self.coulomb()
                };
                (Some(friction), without)
            }
        };
        let rubbing = FrictionSettings {
            friction: coulomb,
            sample_reuse_mm: self.sample_reuse_mm,
        };
        let memory = ContactMemory { state, ..memory };
        DeformableContact::after(memory, bodies, rubbing, compliance)
            .with_history(plastic)
            .with_history(friction)
            .with_history(resting)
    }

    /// Returns the resting backside, if the insert rests, from the stored state.
    fn resting(
        &self,
        state: &ContactState,
        compliance: &Arc<Compliance<ElasticSurface>>,
    ) -> Option<RestingInsert> {
        let Backside::Resting {
            friction,
            spacing_mm,
        } = self.backside
        else {
            return None;
        };
        let memory = BacksideMemory::from_state(state);
        let tray = compliance.source.tray(spacing_mm);
        let compliance = Arc::clone(compliance);
        Some(RestingInsert::after(memory, compliance, tray, friction))
    }

    /// Returns the yielding insert, if it yields, from the stored state.
    fn plastic(
        &self,
        state: &ContactState,
        compliance: &Arc<Compliance<ElasticSurface>>,
    ) -> Option<PlasticInsert> {
        let hardening = self.hardening.clone()?;
        let remembered = PlasticMemory::from_state(state);
        Some(PlasticInsert::after(
            remembered,
            Arc::clone(compliance),
            hardening,
        ))
    }
}

/// The mesh nodes whose compliance was used, mm: unworn, unless the state says others.
fn used_nodes(insert: &Insert, state: &ContactState) -> Vec<Vec3> {
    let field = state.fields.iter().find(|field| field.name == NODES_FIELD);
    match field {
        Some(field) => field
            .values
            .chunks_exact(3)
            .map(Vec3::from_column_slice)
            .collect(),
        None => insert.unworn_nodes().to_vec(),
    }
}

/// The state with the nodes whose compliance is used, and all else that it had.
fn state_of(nodes: &[Vec3], before: &ContactState) -> ContactState {
    let kept = before.fields.iter();
    let kept = kept.filter(|field| field.name != NODES_FIELD);
    let field = StateField {
        name: NODES_FIELD.to_owned(),
        values: nodes.iter().flatten().copied().collect(),
    };
    ContactState {
        fields: [field].into_iter().chain(kept.cloned()).collect(),
    }
}

fn is_much_thinner(insert: &Insert, used: &[Vec3]) -> bool {
    let nodes = insert.surface_nodes().iter().zip(insert.thickness_mm());
    let thinner = |(&node, thickness_mm): (&u32, &f64)| {
        let node = node as usize;
        (insert.mesh().nodes[node] - used[node]).norm() / thickness_mm
    };
    nodes.map(thinner).fold(0.0, f64::max) > MAX_THINNER
}

/// Stress under loads on nodes of the surface along the inward normals, N, and what has yielded, if the insert does.
pub(crate) fn under_surface(
    surface: &ElasticSurface,
    remembered: Option<PlasticMemory>,
    loads: &[(u32, f64)],
) -> UnderSurface {
    let points = remembered.as_ref().map(|remembered| &remembered.points);
    let strains = points.map_or_else(BTreeMap::new, strains_of);
    let moved_mm = surface.moved_by(loads, &strains);
    let stresses = surface.solid().stresses_with(&moved_mm, &strains);
    UnderSurface {
        von_mises_mpa: stresses.iter().map(Stress::von_mises).collect(),
        max_shear_mpa: stresses.iter().map(Stress::max_shear).collect(),
        plastic: remembered.map(|remembered| plastic(surface, &remembered)),
        backside: None,
    }
}

/// The same of an insert that rests on its tray, its backside at rest under the loads from where the activity of that
/// number left it; where it tips off, as if the backside stayed there.
pub(crate) fn above_tray(
    surface: &ElasticSurface,
    tray: &Tray,
    friction: f64,
    memory: &BacksideMemory,
    (activity, loads): (usize, &[(u32, f64)]),
) -> UnderSurface {
    let left_mm = memory.start(activity, tray.freedoms());
    let forces_n = surface.forces_on_tray(tray, loads);
    let found = rest(tray, friction, &left_mm, &forces_n, &left_mm.clone().into());
    let moved_mm = found.map_or(left_mm, |rest| rest.moved_mm);
    let moved_mm = surface.moved_with_tray(loads, tray, &moved_mm);
    let stresses = surface.solid().stresses(&moved_mm);
    let cycle = &memory.last_cycles;
    UnderSurface {
        von_mises_mpa: stresses.iter().map(Stress::von_mises).collect(),
        max_shear_mpa: stresses.iter().map(Stress::max_shear).collect(),
        plastic: None,
        backside: Some(BacksideAtRest {
            lift_mm: cycle.lift_mm,
            lifted_part: cycle.lifted_part,
            slip_mm: cycle.slip_mm,
            lock_force_n: cycle.lock.force_n,
            lock_moment_nmm: cycle.lock.moment_nmm,
        }),
    }
}

fn plastic(surface: &ElasticSurface, remembered: &PlasticMemory) -> PlasticUnderSurface {
    let elements = surface.solid().mesh().hexes.len();
    let mut plastic_strain = vec![0.0; elements];
    let mut regime = vec![Regime::Elastic; elements];
    for (&element, points) in &remembered.points {
        let largest = |largest: f64, point: &PlasticPoint| largest.max(point.accumulated);
        plastic_strain[element as usize] = points.iter().fold(0.0, largest);
        let flow = remembered.flow_in_cycle.get(&element).copied();
        regime[element as usize] = Regime::from_flow(flow.unwrap_or_default());
    }
    let set_mm = if remembered.points.is_empty() {
        vec![0.0; surface.along_normals(&surface.solid().mesh().nodes).len()]
    } else {
        surface.along_normals(&surface.moved_by(&[], &strains_of(&remembered.points)))
    };
    PlasticUnderSurface {
        permanent_set_mm: set_mm,
        plastic_strain,
        regime,
    }
}
