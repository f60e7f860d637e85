//! What a test says of contact.

use std::{fmt::Debug, sync::Arc};

use super::{
    known_compliance::KnownCompliance,
    memory::{ContactMemory, ContactState},
    model::ContactModel,
    under_surface::UnderSurface,
};
use crate::geometry::{ArticulatingSurface, FemoralSurface, Insert};

/// The bodies of a contact as they are now.
#[derive(Clone, Copy)]
pub struct Bodies<'a> {
    /// The femoral surface, made ready for the insert's shares.
    pub femur: &'a FemoralSurface,
    /// The insert, worn or not.
    pub insert: &'a Insert,
    /// The insert's articulating surface.
    pub surface: &'a ArticulatingSurface,
}

/// A law of contact: it belongs to a test, and makes the contact of its bodies.
pub trait ContactLaw: Debug + Send + Sync {
    /// The contact of bodies that goes on from what the contact before left; from nothing, with the
    /// default memory.
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a>;

    /// By how much the pressure at a surface node falls as the node alone is worn by a millimetre,
    /// MPa/mm: how fast wear flattens the pressure follows from it.
    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64;

    /// Bytes that the law keeps of an insert, beside what a contact takes, if the femur comes near so many nodes.
    fn memory_bytes(&self, _insert: &Insert, _nodes_near: f64) -> f64 {
        0.0
    }

    /// What is below the surface of an insert under loads on surface nodes along the inward normals, N, of the activity
    /// of that number, after a contact has left `state`; none of an insert that is no solid.
    fn under_surface(
        &self,
        _insert: &Insert,
        _state: &ContactState,
        _activity: usize,
        _loads: &[(u32, f64)],
    ) -> Option<UnderSurface> {
        None
    }

    /// What is known of the compliance of an unworn insert, for another run; none where that is about no more than so
    /// many pairs of tiles, or no more than was known at first.
    fn known_compliance(
        &self,
        _insert: &Insert,
        _more_than_pairs: usize,
    ) -> Option<KnownCompliance> {
        None
    }

    /// The same law with `factor` times the slip tolerance, for the estimate of what that costs in accuracy.
    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw>;
}
