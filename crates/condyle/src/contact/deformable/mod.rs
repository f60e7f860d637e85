//! The deformable insert: a rigid counterface on an elastic body, without penalty.
//!
//! | file | content |
//! | --- | --- |
//! | `mod` | the law [`Deformable`]: material, friction, backside; compliances that are kept; stress below the surface |
//! | `contact` | one evaluation: gaps, loads, wrench; the same for every material, friction and backside |
//! | `complementarity` | the loads that keep the bodies just in touch |
//! | `changed_factor`, `cholesky` | the factor of the compliance of the nodes in contact, and its updates as few of them change |
//! | `compliance`, `elastic_surface` | the compliance of the surface, by finite elements, of the nodes that come near |
//! | `edge_and_peak` | the part of every share that is in contact, and the peak pressure |
//! | `history` | the interface of state that depends on the load history |
//! | `plastic` | yield below the surface, for any [`Material`] |
//! | `friction`, `stick_slip` | stick and slip along the surface, and the solver for its loads |
//! | `backside` | a backside that rests on its tray |
//!
//! Loads and histories are solved alternately, accelerated by Anderson mixing, until they are consistent.

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
    fmt::Debug,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use condyle_fem::{Elastic, Material, SolidError, Stress};

use super::{
    law::{Bodies, ContactLaw, ContactSettings, KnownCompliance, UnderSurface},
    model::{ContactMemory, ContactModel, ContactState},
};
use crate::{
    Vec3,
    geometry::{ArticulatingSurface, Insert},
};
use backside::{Floor, RestingInsert};
use contact::DeformableContact;
use elastic_surface::ElasticSurface;
use friction::ElasticFriction;
use history::{LoadHistory, field};
use plastic::{Eigenstrains, InsertMaterial};

/// Memory for the compliances of inserts that are kept, bytes: enough for those of an insert and its coarser twin,
/// unworn and worn.
const MAX_KEPT_BYTES: f64 = 3e8;

/// Coulomb's friction on a deformable insert.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionModel {
    /// Friction mu N v / sqrt(v^2 + v0^2) at the sliding speed v; it does not displace the surface along itself.
    #[default]
    Regularised,
    /// The surface deflects tangentially, and each node sticks or slides: a node that carries less than mu N
    /// does not slide.
    /// The loads along the surface are carried from increment to increment.
    StickSlip,
}

/// The support of the backside of a deformable insert on its tray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Backside {
    /// Bonded: it neither lifts nor slips.
    #[default]
    Bonded,
    /// Resting: in contact it sticks or slips with Coulomb friction, elsewhere it lifts. The rim that locks it carries the
    /// net force and moment along the tray.
    Resting {
        /// Coulomb's coefficient of friction.
        friction: f64,
        /// Spacing of the points that carry the motion of the backside, mm.
        spacing_mm: f64,
    },
}

/// The law of an elastic insert under a rigid counterface.
///
/// Small displacements: the surface deflects along its inward normals by the normal compliance C of the insert,
/// computed by finite elements. The loads N at the nodes are those for which the bodies touch without overlap,
///
/// $$ N \ge 0, \quad g + C N \ge 0, \quad N \cdot (g + C N) = 0, $$
///
/// with the gaps g of the undeformed bodies; no constant is tuned. The share of every node carries a pressure along the
/// counterface's normal and Coulomb friction, regularised or with stick and slip. Wear is added to the gap. C is that
/// of the unworn insert, and is recomputed once the insert has become thinner by more than a twentieth. If the material
/// yields, the permanent set due to the flow below the surface is added to the gap; the stiffness does not change.
///
/// Limits: tangential loads cause no normal deflection, and normal loads no tangential deflection; the tray is rigid.
/// An insert that rests on its tray neither yields nor sticks and slips on its surface.
#[derive(Clone, Debug)]
pub struct Deformable {
    elastic: Elastic,
    /// None for an insert that stays elastic.
    material: Option<Arc<dyn InsertMaterial>>,
    /// Friction and search.
    pub settings: ContactSettings,
    /// The model of friction: with or without elastic deflection along the surface.
    pub friction_model: FrictionModel,
    backside: Backside,
    /// Compliances in order of last use, shared by clones of the law.
    kept: Arc<Mutex<Vec<Arc<ElasticSurface>>>>,
}

impl Deformable {
    /// Creates the law of an elastic insert, with regularised friction, and factors its stiffness.
    ///
    /// # Errors
    /// A material or a mesh that does not define an elastic solid: a part of it is not held by the backside, for instance.
    pub fn new(
        elastic: Elastic,
        friction: f64,
        slip_tolerance_mm_per_s: f64,
        backside: Backside,
        insert: &Insert,
    ) -> Result<Self, SolidError> {
        let law = Self {
            elastic,
            material: None,
            settings: ContactSettings::new(friction, slip_tolerance_mm_per_s),
            friction_model: FrictionModel::default(),
            backside,
            kept: Arc::default(),
        };
        law.elastic_surface(insert, insert.unworn_nodes())?;
        Ok(law)
    }

    /// Returns the same law with another support of the backside. The stiffness is factored again if other nodes hold the
    /// insert.
    ///
    /// # Errors
    /// Fails if the support leaves a part of the insert unsupported.
    pub fn with_backside(
        mut self,
        backside: Backside,
        insert: &Insert,
    ) -> Result<Self, SolidError> {
        self.backside = backside;
        self.elastic_surface(insert, insert.unworn_nodes())?;
        Ok(self)
    }

    /// Returns the same law for an insert that yields. Its compliance is recomputed if the elastic constants differ.
    #[must_use]
    pub fn with_material(
        mut self,
        material: impl Material + Clone + Debug + Send + Sync + 'static,
    ) -> Self {
        if material.elastic() != self.elastic {
            self.elastic = material.elastic();
            self.kept = Arc::default();
        }
        self.material = Some(Arc::new(material));
        self
    }

    /// Returns the part of an insert's backside, projected onto the tray, that is flat and can rest.
    ///
    /// Faces that lean by less than 15 degrees from straight down, within a quarter of a millimetre of their median height.
    pub fn flat_part_of_backside(insert: &Insert) -> f64 {
        Floor::from_backside(insert.mesh(), insert.backside_nodes()).part
    }

    /// Returns whether anything is known of the compliance of an unworn insert.
    pub fn knows(&self, insert: &Insert) -> bool {
        let surface = self.find_kept(insert, insert.unworn_nodes());
        surface.is_some_and(|surface| surface.knows())
    }

    /// Takes the compliance of an unworn insert that another run has computed, with the same elastic constants and the same
    /// support of the backside: it is not computed again, and no result depends on it.
    ///
    /// # Errors
    /// A mesh that does not define an elastic solid.
    pub fn know(&self, insert: &Insert, known: KnownCompliance) -> Result<(), SolidError> {
        self.elastic_surface(insert, insert.unworn_nodes())?
            .know(known);
        Ok(())
    }

    fn rests(&self) -> bool {
        matches!(self.backside, Backside::Resting { .. })
    }

    fn kept(&self) -> MutexGuard<'_, Vec<Arc<ElasticSurface>>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the surface of an insert with the given mesh nodes, if it is kept.
    fn find_kept(&self, insert: &Insert, mesh_nodes: &[Vec3]) -> Option<Arc<ElasticSurface>> {
        let rests = self.rests();
        let kept = self.kept();
        let mut kept = kept.iter();
        kept.find(|surface| surface.is_of(insert, mesh_nodes, rests))
            .map(Arc::clone)
    }

    /// Returns the surface of an insert with the given mesh nodes: kept, or computed now.
    fn elastic_surface(
        &self,
        insert: &Insert,
        mesh_nodes: &[Vec3],
    ) -> Result<Arc<ElasticSurface>, SolidError> {
        let rests = self.rests();
        // The lock is held while a surface is computed, so that no other thread computes the same.
        let mut kept = self.kept();
        let place = kept
            .iter()
            .position(|surface| surface.is_of(insert, mesh_nodes, rests));
        let surface = if let Some(place) = place {
            // The surface used last moves to the end; the first one is dropped first.
            kept.remove(place)
        } else {
            // Room for one as large as the newest is made before, so that old and new are not in memory at once.
            let bytes = |surface: &Arc<ElasticSurface>| {
                surface.bytes(surface.normal.known_count() as f64, [1.0, 0.0])
            };
            while let Some(newest) = kept.last()
                && kept.iter().map(bytes).sum::<f64>() + bytes(newest) > MAX_KEPT_BYTES
            {
                kept.remove(0);
            }
            let surface = ElasticSurface::new(insert, mesh_nodes, self.elastic, rests)?;
            Arc::new(surface)
        };
        kept.push(Arc::clone(&surface));
        Ok(surface)
    }

    /// Returns the surface to use for an insert after a contact has left `state`, and the mesh nodes to store for the next
    /// contact if that is not the surface of the unworn insert.
    fn surface_after(
        &self,
        insert: &Insert,
        state: &ContactState,
    ) -> (Arc<ElasticSurface>, Option<Vec<f64>>) {
        let stored = state.named(NODES_FIELD).next().cloned();
        let used = match &stored {
            Some(numbers) => numbers
                .chunks_exact(3)
                .map(Vec3::from_column_slice)
                .collect(),
            None => insert.unworn_nodes().to_vec(),
        };
        let now = &insert.mesh().nodes;
        let nodes = insert.surface_nodes().iter().zip(insert.thickness_mm());
        let thinner = |(&node, thickness_mm): (&u32, &f64)| {
            (now[node as usize] - used[node as usize]).norm() / thickness_mm
        };
        if nodes.map(thinner).fold(0.0, f64::max) > MAX_THINNER
            && let Ok(renewed) = self.elastic_surface(insert, now)
        {
            return (renewed, Some(now.iter().flatten().copied().collect()));
        }
        let surface = self.elastic_surface(insert, &used);
        // A case checks its insert as it is built.
        (surface.expect("the insert is an elastic solid"), stored)
    }
}

/// An insert that has become thinner by more than this part somewhere gets a new compliance. Wear is in the gap; an insert
/// thinner by 4 % has a compliance that changes the peak pressure by half a percent.
const MAX_THINNER: f64 = 0.05;

/// The field of the contact's state that holds the mesh nodes whose compliance is used, x, y and z of each.
const NODES_FIELD: &str = "compliance_nodes_mm";

/// The fall of the pressure at a node as the node alone recedes, times edge over contact modulus: 1.2 on a half-space if
/// pressure is even over squares, and 1.7 for squares that deflect by turns; more where elements are stiffer than the
/// body.
const ALONE: f64 = 1.9;

/// Memory of an insert together with that of the coarser insert of the error estimate, relative to the insert alone.
const WITH_TWIN: f64 = 1.5;

impl ContactLaw for Deformable {
    /// # Panics
    /// If an insert other than that from which the law was made does not define an elastic solid, or if an insert that rests on
    /// its tray yields, or sticks and slips on its surface.
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a> {
        let ContactMemory { state, cache } = memory;
        let (surface, nodes) = self.surface_after(bodies.insert, &state);
        let mut settings = self.settings;
        let mut histories: Vec<Box<dyn LoadHistory + 'a>> = Vec::new();
        if let Some(material) = &self.material {
            histories.push(material.history(Arc::clone(&surface), &state));
        }
        // Without friction nothing sticks, and the limits of all nodes would be 0.
        if self.friction_model == FrictionModel::StickSlip && settings.friction > 0.0 {
            let along = Arc::clone(surface.tangential());
            let history = ElasticFriction::new(&state, settings.friction, bodies.surface, along);
            histories.push(Box::new(history));
            // The history exerts friction in place of the regularised law.
            settings.friction = 0.0;
        }
        if let Backside::Resting {
            friction,
            spacing_mm,
        } = self.backside
        {
            assert!(
                histories.is_empty(),
                "a resting insert neither yields nor sticks"
            );
            let (tray, surface) = (surface.tray(spacing_mm), Arc::clone(&surface));
            histories.push(Box::new(RestingInsert::new(
                &state, surface, tray, friction,
            )));
        }
        let fields = nodes.map(|nodes| field(NODES_FIELD, nodes));
        let memory = ContactMemory {
            state: ContactState {
                fields: fields.into_iter().collect(),
            },
            cache,
        };
        let compliance = Arc::clone(&surface.normal);
        let contact = DeformableContact::new(memory, bodies, settings, compliance, histories);
        Box::new(contact)
    }

    fn surface(&self, insert: &Insert) -> ArticulatingSurface {
        insert.surface().with_tributary_areas()
    }

    /// Returns the stiffness of a node of an elastic half-space: what deflects along with a node alone is no deeper
    /// than its share is wide.
    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64 {
        let ratio = self.elastic.poissons_ratio;
        let contact_modulus_mpa = self.elastic.youngs_modulus / (1.0 - ratio * ratio);
        ALONE * contact_modulus_mpa / insert.unworn_share_mm2(node).sqrt()
    }

    fn memory_bytes(&self, insert: &Insert, nodes_near: f64) -> f64 {
        let Ok(surface) = self.elastic_surface(insert, insert.unworn_nodes()) else {
            return 0.0;
        };
        let along_surface = match self.friction_model {
            FrictionModel::Regularised => 0.0,
            FrictionModel::StickSlip => 2.0,
        };
        let bytes = surface.bytes(nodes_near, [1.0, along_surface]);
        // The coarser twin of the insert and the worn insert are kept besides.
        let kept = bytes.min(MAX_KEPT_BYTES);
        let below = if self.material.is_some() {
            WITH_TWIN * surface.bytes_below(nodes_near)
        } else {
            0.0
        };
        let at_backside = match self.backside {
            Backside::Bonded => 0.0,
            Backside::Resting { spacing_mm, .. } => {
                WITH_TWIN * surface.bytes_of_tray(spacing_mm, nodes_near)
            }
        };
        bytes + kept + below + at_backside
    }

    fn under_surface(
        &self,
        insert: &Insert,
        state: &ContactState,
        activity: usize,
        loads: &[(u32, f64)],
    ) -> Option<UnderSurface> {
        let (surface, _) = self.surface_after(insert, state);
        let mut under = UnderSurface::default();
        let (moved_mm, strains) = match self.backside {
            Backside::Bonded => {
                let material = self.material.as_ref();
                let plastic = material.map(|material| material.under_surface(&surface, state));
                let (strains, plastic) = plastic.unzip();
                under.plastic = plastic;
                let strains = strains.unwrap_or_default();
                (surface.moved_by(loads, &strains), strains)
            }
            Backside::Resting {
                friction,
                spacing_mm,
            } => {
                let tray = surface.tray(spacing_mm);
                let (left_mm, last_cycles) = backside::stored(state, activity, &tray);
                under.backside = Some(last_cycles);
                // In equilibrium from where the activity left it; if it tips off, as if it stayed there.
                let forces_n = surface.forces_on_tray(&tray, loads);
                let found = tray.rest(friction, &left_mm, &forces_n, &left_mm.clone().into());
                let moved_mm = found.map_or(left_mm, |rest| rest.moved_mm);
                let moved_mm = surface.moved_with_tray(loads, &tray, &moved_mm);
                (moved_mm, Eigenstrains::new())
            }
        };
        let stresses = surface.solid.stresses(&moved_mm, &strains);
        under.von_mises_mpa = stresses.iter().map(Stress::von_mises).collect();
        under.max_shear_mpa = stresses.iter().map(Stress::max_shear).collect();
        Some(under)
    }

    fn known_compliance(&self, insert: &Insert, more_than_pairs: usize) -> Option<KnownCompliance> {
        let surface = self.find_kept(insert, insert.unworn_nodes())?;
        surface.known(more_than_pairs)
    }

    fn slip_tolerance_mm_per_s(&self) -> Option<f64> {
        let is_regularised = self.friction_model == FrictionModel::Regularised;
        let tolerance = self.settings.slip_tolerance_of_friction();
        tolerance.filter(|_| is_regularised)
    }

    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw> {
        let mut law = self.clone();
        law.settings.slip_tolerance_mm_per_s *= factor;
        Arc::new(law)
    }
}
