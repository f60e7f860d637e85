//! The interface between the machine and a contact.

use std::{any::Any, fmt};

use serde::{Deserialize, Serialize};

use crate::{
    Vec3,
    spatial::{RelativeMotion, Wrench, WrenchByTwist},
};

/// The number of regions of an articulating surface with loads and slips of their own: the two sides of a knee.
pub const MAX_REGIONS: usize = 2;

/// The derivatives of the wrench of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// Derivative of the wrench on the insert by a short motion of the femur.
    pub by_pose: WrenchByTwist,
    /// Derivative of the wrench on the insert by the femur's twist.
    pub by_twist: WrenchByTwist,
}

/// Gives the derivatives of a response, which are dear and not always asked for.
pub trait Linearization {
    /// The derivatives of the wrench at the response.
    fn tangent(&self) -> Tangent;
}

/// The response of a contact to a motion.
pub struct Response<'a> {
    /// Wrench on the insert about its origin, in the insert frame.
    pub wrench: Wrench,
    /// Velocity of the femur's surface past the insert's in each region, the mean weighted by load,
    /// mm/s; in the femoral frame.
    pub mean_slip: [Vec3; MAX_REGIONS],
    linearization: &'a dyn Linearization,
}

impl<'a> Response<'a> {
    /// A response whose derivatives `linearization` gives when they are asked for.
    pub fn new(
        wrench: Wrench,
        mean_slip: [Vec3; MAX_REGIONS],
        linearization: &'a dyn Linearization,
    ) -> Self {
        Self {
            wrench,
            mean_slip,
            linearization,
        }
    }

    /// Returns the derivatives of the wrench at this response.
    pub fn tangent(&self) -> Tangent {
        self.linearization.tangent()
    }
}

impl fmt::Debug for Response<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Response")
            .field("wrench", &self.wrench)
            .field("mean_slip", &self.mean_slip)
            .finish_non_exhaustive()
    }
}

/// A surface node in contact; vectors in the insert frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchedNode {
    /// Number of the surface node.
    pub node: u32,
    /// The region of the surface that it belongs to.
    pub region: u8,
    /// Mean pressure on the node's share of the surface, MPa.
    pub pressure_mpa: f64,
    /// Area of the part of the share that presses, mm2.
    pub covered_mm2: f64,
    /// Force on the insert there, N.
    pub force_n: Vec3,
    /// Velocity of the femur's surface past the insert's in the surface's own directions, anterior
    /// along the surface, then lateral, mm/s; 0 where they stick.
    pub sliding_mm_per_s: [f64; 2],
    /// The displacement of the insert's surface along itself with the femur since the increment before, in the same
    /// directions, mm: the part of the sliding that is no slip. 0 where they stick, and in a contact that does not deflect along
    /// its surface.
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

/// The state of a contact's search for its history variables at a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settled {
    /// Found: the step may be accepted.
    Yes,
    /// Changed since the last response: the step is to be solved again.
    RespondAgain,
}

/// A load that the insert does not bear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotBorne {
    /// The material yields without finding a balance.
    Flattened {
        /// The largest plastic strain when the search was given up.
        plastic_strain: f64,
    },
    /// The insert rests on its tray and tips off it.
    Tipped {
        /// The largest displacement of the backside when the search was given up, mm.
        moved_mm: f64,
    },
}

/// A contact between femur and insert: the machine sees this, never a mesh.
///
/// The machine asks [`respond`](Self::respond) as often as it needs to find an increment's end, says
/// [`accept`](Self::accept) once for every step that it goes on from, and [`evaluate`](Self::evaluate) where an
/// increment ends.
pub trait ContactModel {
    /// Returns the number of surface nodes.
    fn node_count(&self) -> usize;

    /// The next increments are of another cycle than those before, that of another activity for instance.
    fn begin_cycle(&mut self) {}

    /// The next motions are of this increment of the cycle, much like those of the same increment a
    /// cycle before.
    ///
    /// A hint that makes a model quicker, and changes none of its answers.
    fn begin_increment(&mut self, _increment: usize) {}

    /// Returns the response to a relative motion.
    ///
    /// The answer depends on the motion and on what was accepted, not on the responses before, but
    /// for what a model says it rounds.
    fn respond(&mut self, motion: &RelativeMotion) -> Response<'_>;

    /// A step is to end at a motion, that of the last response or one as near: a model with a history finds what
    /// the step adds to it, in trial, and the responses after that are with it.
    ///
    /// # Errors
    /// A load that the insert does not bear.
    fn settle(&mut self, _motion: &RelativeMotion) -> Result<Settled, NotBorne> {
        Ok(Settled::Yes)
    }

    /// The step that settled last is not gone on from: what it would have added is dropped.
    fn reject(&mut self) {}

    /// Returns the distance of the surface at rest from its place at the same increment a cycle before, mm, times how
    /// much more exactly than a motion it is to repeat itself; a cycle does not before that has become small.
    fn moved_in_a_cycle_mm(&self) -> f64 {
        0.0
    }

    /// A step has ended at a motion, and the machine goes on from there: a model with a history adds
    /// the step to it. The motion is that of the last response, or so near that the model may take the
    /// difference to first order.
    fn accept(&mut self, _motion: &RelativeMotion) {}

    /// The nodes in contact and the highest pressure at a motion: that of the last response, or one so
    /// near that loads and speeds may be taken along to first order.
    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult;

    /// Returns the memory from which the next contact resumes.
    fn into_memory(self: Box<Self>) -> ContactMemory {
        ContactMemory::default()
    }
}

/// The memory that a contact leaves to the next one.
#[derive(Debug, Default)]
pub struct ContactMemory {
    /// The part that results depend on.
    pub state: ContactState,
    /// The part that makes the next contact quicker and changes none of its results.
    pub cache: ContactCache,
}

/// The history of a contact whose answers depend on it: plastic strains, for instance. A march keeps
/// it in its checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// The fields, in an order of the law's own.
    pub fields: Vec<StateField>,
}

/// A field of a contact's history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StateField {
    /// Its name, which ends in its unit.
    pub name: String,
    /// Its numbers, in an order of the law's own.
    pub values: Vec<f64>,
}

/// Whatever a contact likes to keep for the next one; each law knows its own.
#[derive(Debug, Default)]
pub struct ContactCache(Option<Box<dyn Any + Send + Sync>>);

impl ContactCache {
    /// Keeps a value.
    pub fn new<T: Any + Send + Sync>(value: T) -> Self {
        Self(Some(Box::new(value)))
    }

    /// The value that was kept, if it is of this type.
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
