//! The deformable insert as a law of contact.

use std::sync::Arc;

use super::{
    backside::{BacksideMemory, RestingInsert},
    compliance::Compliance,
    contact::{DeformableContact, FrictionSettings},
    elastic_surface::ElasticSurface,
    friction::ElasticFriction,
    friction_memory::FrictionMemory,
    plastic::{PlasticInsert, Remembered},
    settings::{Backside, Deformable, FrictionModel, MAX_REMEMBERED_BYTES},
    under_surface::{above_tray, under_surface},
};
use crate::{
    Vec3,
    contact::{
        broad_phase::{BroadPhase, BruteForce, Coherent, Search},
        contact_law::{Bodies, ContactLaw},
        known_compliance::KnownCompliance,
        memory::{ContactMemory, ContactState, StateField},
        model::ContactModel,
        pressed::Coulomb,
        under_surface::UnderSurface,
    },
    geometry::Insert,
};

/// An insert that has become thinner by more than this part somewhere since its compliance was computed gets a
/// new one.
///
/// Wear is in the gap; what the compliance of an insert thinner by 4 % differs by changes the peak pressure by
/// half a percent.
const MAX_THINNER: f64 = 0.05;

/// The field of the contact's state that holds the mesh nodes whose compliance is used, x, y and z of each.
const NODES_FIELD: &str = "compliance_nodes_mm";

/// How much the pressure at a node falls as the node alone gives way, times edge over contact modulus: 1.2 on a
/// half-space where pressure is even over squares, and 1.7 for squares that give way by turns; more where elements
/// are stiffer than the body.
const ALONE: f64 = 1.9;

/// What an insert and its coarser twin take, of what the insert does.
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

    /// That of a node of an elastic half-space: what gives way along with a node alone is no deeper than its
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
            // The coarser twin of the insert, and the insert as it has worn, are kept beside.
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
                let remembered = self.hardening.as_ref().map(|_| Remembered::of(&state));
                under_surface(surface, remembered, loads)
            }
            Backside::Resting {
                friction,
                spacing_mm,
            } => {
                let (tray, memory) = (surface.tray(spacing_mm), BacksideMemory::of(&state));
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
                let memory = FrictionMemory::of(&state);
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
            .yielding(plastic)
            .sticking(friction)
            .resting(resting)
    }

    /// How the insert rests on its tray, if it does, after what the state remembers.
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
        let memory = BacksideMemory::of(state);
        let tray = compliance.source.tray(spacing_mm);
        let compliance = Arc::clone(compliance);
        Some(RestingInsert::after(memory, compliance, tray, friction))
    }

    /// How the insert yields, if it does, after what the state remembers.
    fn plastic(
        &self,
        state: &ContactState,
        compliance: &Arc<Compliance<ElasticSurface>>,
    ) -> Option<PlasticInsert> {
        let hardening = self.hardening.clone()?;
        let remembered = Remembered::of(state);
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
