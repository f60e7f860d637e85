//! The insert that yields below its surface.
//!
//! Plastic strain is an eigenstrain of the elastic insert: its forces on the nodes move the surface (the permanent
//! set, which goes into the gap) and leave stress. Stiffness and compliance stay. `influence` keeps what loads and
//! plastic strains move below the surface, `insert` finds the flow under the loads of an increment (led by Anderson's mixing), `cycle` tells
//! what flows in a cycle that repeats, and `memory` is what the next contact goes on from.

mod cycle;
mod influence;
mod insert;
mod memory;
#[cfg(test)]
mod tests;

pub(super) use cycle::{CycleOfFlow, farthest_mm};
pub(super) use influence::Influence;
pub(super) use insert::{FOUND_MM, NodeLoad, PlasticInsert, strains_of};
pub(super) use memory::{PLASTIC_FIELD, Remembered};

use std::collections::BTreeMap;

use condyle_fem::PlasticPoint;

/// Gauss points of an element.
const POINTS: usize = 8;

/// What the Gauss points of elements that have yielded remember, by the number of the element.
pub(super) type Points = BTreeMap<u32, [PlasticPoint; POINTS]>;
