//! How a deformable insert presses and rubs.

use std::sync::{Arc, Mutex, PoisonError};

use condyle_fem::{Elastic, Hardening, SolidError};

use super::{
    backside::Floor,
    compliance::Compliance,
    elastic_surface::{ElasticSurface, HeldBy},
};
use crate::{
    Vec3,
    contact::{
        broad_phase::Search, foundation::Foundation, known_compliance::KnownCompliance,
        pressed::Coulomb,
    },
    geometry::Insert,
};

/// So much of the compliances of inserts is remembered, bytes: of a knee that of the insert and of its coarser twin,
/// unworn and worn.
pub(super) const MAX_REMEMBERED_BYTES: f64 = 3e8;

/// Coulomb's friction on a deformable insert.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionModel {
    /// It goes with the sliding speed, mu N v / sqrt(v^2 + v0^2), and does not move the surface along itself.
    #[default]
    Regularised,
    /// The surface gives way along itself, and each node sticks or slides: what carries less than mu N does not slide. What
    /// each carries is remembered from increment to increment.
    StickSlip,
}

/// What holds the backside of a deformable insert on its tray.
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
/// Small displacements: the surface gives way along its inward normals by the normal compliance C of the insert,
/// computed by finite elements. The loads N at the nodes hold the bodies just in touch where they press,
///
/// $$ N \ge 0, \quad g + C N \ge 0, \quad N \cdot (g + C N) = 0, $$
///
/// with the gaps g of the bodies at rest: nothing is tuned. Every node's share of the surface presses along the
/// femur's normal and rubs with Coulomb friction, regularised or with stick and slip. Wear goes into the gap; C is that of the insert
/// unworn, and made anew where an insert has become thinner by more than a twentieth. With a yield stress the insert flows below
/// its surface (von Mises, small strains), and what that leaves of a dent goes into the gap; the stiffness stays.
/// Limits: loads along the surface do not move it along its normal, nor do normal loads along it; a tray that does not give.
/// An insert that rests on its tray neither yields nor sticks and slips on its surface.
#[derive(Debug)]
pub struct Deformable {
    /// The elastic material, MPa.
    pub elastic: Elastic,
    /// Coulomb's coefficient of friction, mu.
    pub friction: f64,
    /// Whether the surface gives way along itself under friction.
    pub friction_model: FrictionModel,
    /// Speed at which friction has reached 71 % of its full value, v0, mm/s, > 0; of regularised friction.
    pub slip_tolerance_mm_per_s: f64,
    /// How the nodes that may touch are found; no answer depends on it.
    pub search: Search,
    /// Motion up to which a sample of the femur is extrapolated, mm; 0 takes every sample anew.
    pub sample_reuse_mm: f64,
    /// The yield stress of the insert, MPa, if it yields.
    pub hardening: Option<Hardening>,
    /// What holds the backside.
    pub(super) backside: Backside,
    remembered: Arc<Remembered>,
}

/// Compliances of inserts, the one that was used last at the end; clones of a law share them.
#[derive(Debug, Default)]
struct Remembered(Mutex<Vec<Arc<Compliance<ElasticSurface>>>>);

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

    /// The same law of an insert whose backside is held so; where it rests on its flat part the stiffness is factored anew if
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

    /// How much of an insert's backside is flat, of what a tray below sees: what can rest.
    ///
    /// Faces that lean by less than 15 degrees from straight down, within a quarter of a millimetre of their middle height.
    pub fn flat_part_of_backside(insert: &Insert) -> f64 {
        Floor::of(insert.mesh(), insert.backside_nodes()).part
    }

    /// The surface of an insert with its mesh nodes there: remembered, or made anew.
    pub(super) fn surface(
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
    pub(super) fn remembered(
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

    /// Whether anything is known of the compliance of an unworn insert.
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

    pub(super) fn coulomb(&self) -> Coulomb {
        Coulomb {
            coefficient: self.friction,
            slip_tolerance_mm_per_s: self.slip_tolerance_mm_per_s,
        }
    }
}

/// Where the surface of an insert with its mesh nodes there is.
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
