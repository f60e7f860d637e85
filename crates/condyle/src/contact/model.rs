//! The interface between the machine and a contact.

use std::any::Any;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::{
    Vec3,
    spatial::{RelativeMotion, Wrench, WrenchByTwist},
};

/// The largest number of regions of an articulating surface with separate loads and slips: its two sides.
pub const MAX_REGIONS: usize = 2;

/// The derivatives of the wrench of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// Derivative of the wrench on the insert by a short motion of the counterface.
    pub by_pose: WrenchByTwist,
    /// Derivative of the wrench on the insert by the counterface's twist.
    pub by_twist: WrenchByTwist,
}

/// The response of a contact to a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Wrench on the insert about its origin, in the insert frame.
    pub wrench: Wrench,
    /// Load-weighted mean velocity of the counterface's surface past the insert's in each region, mm/s; in the counterface frame.
    pub mean_slip: [Vec3; MAX_REGIONS],
}

/// A surface node in contact; vectors in the insert frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchedNode {
    /// Number of the surface node.
    pub node: u32,
    /// The region of the surface to which it belongs.
    pub region: u8,
    /// Mean pressure on the node's share of the surface, MPa.
    pub pressure_mpa: f64,
    /// Area of the part of the share that is in contact, mm2.
    pub covered_mm2: f64,
    /// Force on the insert there, N.
    pub force_n: Vec3,
    /// Velocity of the counterface's surface past the insert's in the surface's own directions, anterior along the surface, then
    /// lateral, mm/s; 0 where they stick.
    pub sliding_mm_per_s: [f64; 2],
    /// Displacement of the insert's surface along itself since the increment before, in the same directions, mm: the part of
    /// the sliding that is no slip. 0 where they stick, and in a contact without deflection along the surface.
    pub along_mm: [f64; 2],
}

/// The result of a contact at the end of an increment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactResult {
    /// The nodes in contact, each once and always in the same order.
    pub touched: Vec<TouchedNode>,
    /// Highest pressure anywhere, at nodes and between them, MPa: not below the largest mean over a
    /// node's share.
    pub peak_pressure_mpa: f64,
}

/// The outcome of [`ContactModel::settle`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// Loads and history agree: the step may be accepted.
    Yes,
    /// The history has changed since the last response: the step is to be solved again.
    RespondAgain,
}

/// The insert cannot bear the load. The message continues "the load ...".
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NotBorne {
    /// The material yields, and no equilibrium is found.
    #[error(
        "presses the insert flat: no equilibrium is found, with a plastic strain of {plastic_strain:.2}; let a load that yields \
         deeply at the start of the cycle grow over the first increments, check the load, and [contact.deformable] \
         yield_stress_mpa and its hardening, or take plasticity = \"none\""
    )]
    Flattened { plastic_strain: f64 },
    /// The insert rests on its tray and tips off it.
    #[error(
        "tips the insert off its tray: its backside finds no equilibrium, and had moved by {moved_mm:.2e} mm when the search \
         ended; check whether the load lies within the tray, or set [contact.deformable] backside = \"bonded\""
    )]
    Tipped { moved_mm: f64 },
}

/// A contact between counterface and insert, as the machine sees it: without meshes.
///
/// The machine calls [`respond`](Self::respond) as often as it needs to find the end of an increment,
/// [`accept`](Self::accept) once for every step from which it continues, and [`evaluate`](Self::evaluate) at the end of
/// an increment. A model with a history, such as plastic strain, is settled before a step is accepted.
pub trait ContactModel {
    /// Returns the number of surface nodes.
    fn node_count(&self) -> usize;

    /// Begins the cycle of the next activity; it is called once for each activity.
    fn begin_cycle(&mut self) {}

    /// Begins an increment, whose motions are near those of the same increment of the previous cycle.
    ///
    /// It makes the model faster without changing its responses. A model that yields or slips by Coulomb's law also compares each
    /// increment with that of the previous cycle: without the calls, it does not see that cycles repeat.
    fn begin_increment(&mut self, _increment: usize) {}

    /// Returns the response to a relative motion.
    ///
    /// It depends on the motion and on the accepted history, not on the responses before, except for a model's documented
    /// round-off.
    fn respond(&mut self, motion: &RelativeMotion) -> Response;

    /// Returns the derivatives of the wrench at the last response. They are expensive, and not every response needs them.
    fn tangent(&self) -> Tangent;

    /// Updates the trial history for a step that ends at `motion`, which is that of the last response or very near it.
    /// Later responses use the updated history.
    ///
    /// # Errors
    /// If the insert cannot carry the load.
    fn settle(&mut self, _motion: &RelativeMotion) -> Result<Settled, NotBorne> {
        Ok(Settled::Yes)
    }

    /// Discards the trial history: no further step continues from this one.
    fn reject(&mut self) {}

    /// Returns the change of the surface at rest from the same increment of the previous cycle, mm, scaled by the ratio
    /// of the tolerance of a motion to the tolerance of this change. A cycle repeats itself once this is small.
    fn moved_in_a_cycle_mm(&self) -> f64 {
        0.0
    }

    /// Accepts a step that ends at `motion` and commits the trial history, if the model has one. `motion` is that of the
    /// last response, or near enough for extrapolation to first order.
    fn accept(&mut self, _motion: &RelativeMotion) {}

    /// Returns the nodes in contact and the highest pressure at a motion: that of the last response, or so near that loads
    /// and speeds may be extrapolated to first order.
    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult;

    /// Returns the memory from which the next contact resumes.
    fn into_memory(self: Box<Self>) -> ContactMemory {
        ContactMemory::default()
    }
}

/// The memory that a contact leaves to the next one, with the same counterface and an insert that may have worn. With another
/// counterface, bounds from the memory could miss contact.
#[derive(Debug, Default)]
pub struct ContactMemory {
    /// The part on which results depend.
    pub state: ContactState,
    /// The part that accelerates the next contact without changing its results.
    pub cache: ContactCache,
}

/// The history on which a contact's results depend, such as plastic strains. It is part of a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// The fields, in an order that the law defines.
    pub fields: Vec<StateField>,
}

impl ContactState {
    /// Returns the numbers of every field of this name, in order.
    pub(crate) fn named(&self, name: &str) -> impl Iterator<Item = &Vec<f64>> {
        let fields = self.fields.iter().filter(move |field| field.name == name);
        fields.map(|field| &field.values)
    }
}

/// A field of a contact's history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StateField {
    /// The name, which ends in the unit.
    pub name: String,
    /// The numbers, in an order that the law defines.
    pub values: Vec<f64>,
}

/// Data of any type that a contact model passes to the next contact model of the same law.
#[derive(Debug, Default)]
pub struct ContactCache(Option<Box<dyn Any + Send + Sync>>);

impl ContactCache {
    /// Keeps a value.
    pub fn new<T: Any + Send + Sync>(value: T) -> Self {
        Self(Some(Box::new(value)))
    }

    /// Returns the value that was kept, if it is of this type.
    pub fn into_inner<T: Any>(self) -> Option<T> {
        let value = self.0?.downcast::<T>().ok()?;
        Some(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cache_gives_its_value_to_the_law_that_kept_it_alone() {
        assert_eq!(ContactCache::new(3_u8).into_inner::<u8>(), Some(3));
        assert_eq!(ContactCache::new(3_u8).into_inner::<u16>(), None);
        assert_eq!(ContactCache::default().into_inner::<u8>(), None);
    }
}
