//! The law of contact of a test, and its results on compliance and on the state below the surface.

use std::{collections::BTreeMap, fmt::Debug, sync::Arc};

use serde::{Deserialize, Serialize};

use super::{
    broad_phase::Search,
    model::{ContactMemory, ContactModel, ContactState},
};
use crate::geometry::{ArticulatingSurface, Counterface, Insert};

/// The bodies of a contact as they are now.
#[derive(Clone, Copy)]
pub struct Bodies<'a> {
    /// The counterface, prepared for the insert's shares.
    pub counterface: &'a Counterface,
    /// The insert, worn or not.
    pub insert: &'a Insert,
    /// The insert's articulating surface, as [`ContactLaw::surface`] returns it.
    pub surface: &'a ArticulatingSurface,
}

/// The settings that all laws of contact have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings {
    /// Coulomb's coefficient of friction, mu.
    pub friction: f64,
    /// Speed at which regularised friction has reached 71 % of its full value, v0, mm/s, > 0.
    ///
    /// A smaller value is closer to stick and slip; a larger one lets parts that should stick creep, and is easier to
    /// solve.
    pub slip_tolerance_mm_per_s: f64,
    /// The search for the nodes that may touch; no result depends on it.
    pub search: Search,
    /// Motion up to which a sample of the counterface is extrapolated to second order rather than recomputed, mm; with 0 every
    /// sample is recomputed.
    ///
    /// This is the only approximation of the search. The second derivatives of a mesh's field vary
    /// by about 0.003/mm from cell to cell: at 0.02 mm the error of the gap is less than a
    /// millionth of a millimetre, and the force by a hundred-thousandth.
    pub sample_reuse_mm: f64,
}

impl ContactSettings {
    /// The default motion up to which samples are extrapolated, mm. Most Newton corrections are shorter, so a mesh's field
    /// is mostly sampled once per increment.
    pub const SAMPLE_REUSE_MM: f64 = 0.02;

    /// Creates the settings with the fast search.
    pub fn new(friction: f64, slip_tolerance_mm_per_s: f64) -> Self {
        Self {
            friction,
            slip_tolerance_mm_per_s,
            search: Search::default(),
            sample_reuse_mm: Self::SAMPLE_REUSE_MM,
        }
    }

    /// Returns the slip tolerance if there is friction.
    pub(super) fn slip_tolerance_of_friction(&self) -> Option<f64> {
        (self.friction > 0.0).then_some(self.slip_tolerance_mm_per_s)
    }
}

/// A law of contact. It belongs to a test and creates the contact of its bodies.
pub trait ContactLaw: Debug + Send + Sync {
    /// Creates the contact of bodies. It resumes from the memory of the contact before; the default memory starts without history.
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a>;

    /// Returns the articulating surface of an insert, with the areas that the pressures of the contact act on.
    fn surface(&self, insert: &Insert) -> ArticulatingSurface {
        insert.surface()
    }

    /// Returns the fall of the pressure at a surface node as that node alone is worn, MPa/mm. It determines how fast wear
    /// flattens the pressure.
    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64;

    /// Estimates the memory that the law keeps for an insert in addition to that of a contact, bytes, from the number
    /// of nodes that come near the counterface.
    fn memory_bytes(&self, _insert: &Insert, _nodes_near: f64) -> f64 {
        0.0
    }

    /// Returns the state below the surface of an insert under loads on surface nodes along the inward normals, N, of the
    /// activity with that number, after a contact has left `state`; none for a law that does not model the interior.
    fn under_surface(
        &self,
        _insert: &Insert,
        _state: &ContactState,
        _activity: usize,
        _loads: &[(u32, f64)],
    ) -> Option<UnderSurface> {
        None
    }

    /// Returns the known compliance of an unworn insert, for another run; none if it has no more than
    /// `_more_than_pairs` pairs of tiles, or no more than were known initially.
    fn known_compliance(
        &self,
        _insert: &Insert,
        _more_than_pairs: usize,
    ) -> Option<KnownCompliance> {
        None
    }

    /// Returns the sliding speed at which its friction has 71 % of its full value, mm/s; none for a law without regularised friction.
    fn slip_tolerance_mm_per_s(&self) -> Option<f64> {
        None
    }

    /// Returns the same law with `factor` times the slip tolerance, to estimate its effect on the results.
    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw>;
}

/// The known part of the normal compliance of an insert's surface, mm/N: the displacements of the nodes of one tile by unit
/// loads on another, for the pairs of tiles that were needed.
///
/// It depends on the mesh, its backside, its articulating surface and the elastic constants only, and is exact to the bit:
/// a run that starts with it has the same bytes as one that does not.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KnownCompliance {
    /// By the numbers of two tiles, the lower first; row-major, a row for each node of the first.
    between: BTreeMap<(u32, u32), Vec<f64>>,
}

impl KnownCompliance {
    /// Returns the number of known pairs of tiles.
    pub fn pairs(&self) -> usize {
        self.between.len()
    }

    /// Estimates its memory, bytes.
    pub fn bytes(&self) -> usize {
        let numbers: usize = self.between.values().map(Vec::len).sum();
        size_of::<f64>() * (numbers + 2 * self.pairs())
    }

    /// Removes and returns the compliance between two tiles with the given numbers of nodes: row-major, a row for
    /// each node of `one`.
    pub(crate) fn take(&mut self, one: usize, other: usize, nodes: [usize; 2]) -> Option<Vec<f64>> {
        let [rows, columns] = nodes;
        let key = [one.min(other), one.max(other)].map(|tile| tile as u32);
        let known = self.between.remove(&(key[0], key[1]))?;
        if known.len() != rows * columns {
            return None;
        }
        if one <= other {
            return Some(known);
        }
        let of_row = |row: usize| (0..columns).map(move |column| (row, column));
        let places = (0..rows).flat_map(of_row);
        Some(
            places
                .map(|(row, column)| known[column * rows + row])
                .collect(),
        )
    }

    /// Adds the compliance between a tile and another whose number is not lower.
    pub(crate) fn add(&mut self, one: usize, other: usize, moved: Vec<f64>) {
        self.between.insert((one as u32, other as u32), moved);
    }
}

/// A place counts as shaken down if less plastic strain than this accumulates in a cycle: the flow of an increment is
/// found to about 3e-6.
const SHAKEN_DOWN: f64 = 1e-5;

/// The state below the surface of an insert that is a solid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnderSurface {
    /// The von Mises stress of every element, of the mean stress over the element, MPa.
    pub von_mises_mpa: Vec<f64>,
    /// The largest shear stress of every element, of the same mean, MPa.
    pub max_shear_mpa: Vec<f64>,
    /// The plastic state, if the insert yields.
    pub plastic: Option<PlasticUnderSurface>,
    /// The motion of the backside in the last cycles, if it rests on its tray.
    pub backside: Option<BacksideAtRest>,
}

/// The extremes of a resting backside in the last cycle of any activity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BacksideAtRest {
    /// Largest lift of a place of it off the tray, mm.
    pub lift_mm: f64,
    /// Largest part of it that lifts at once.
    pub lifted_part: f64,
    /// Largest slip of a place of it along the tray while in contact, there and back, mm.
    pub slip_mm: f64,
    /// Largest force along the tray that the lock carries, N.
    pub lock_force_n: f64,
    /// Largest moment about the vertical axis that the lock carries, N mm.
    pub lock_moment_nmm: f64,
}

/// The plastic state of an insert.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlasticUnderSurface {
    /// The permanent set of every node of the surface along the inward normal, mm.
    pub permanent_set_mm: Vec<f64>,
    /// The largest accumulated plastic strain at the Gauss points of every element.
    pub plastic_strain: Vec<f64>,
    /// The regime of every element in a cycle that repeats itself.
    pub regime: Vec<Regime>,
}

/// The regime of a place of an insert in a cycle that repeats itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Regime {
    /// The place has never yielded.
    #[default]
    Elastic,
    /// It has yielded, and is elastic in the present cycle.
    ShakenDown,
    /// It yields in every cycle: its strain grows or alternates.
    Ratcheting,
}

impl Regime {
    /// Returns the regime of a place that has yielded, from the plastic strain that accumulates in a cycle.
    pub(crate) fn from_flow(plastic_strain: f64) -> Self {
        if plastic_strain > SHAKEN_DOWN {
            Self::Ratcheting
        } else {
            Self::ShakenDown
        }
    }

    /// Returns its number in files: 0 elastic, 1 shaken down, 2 ratcheting.
    pub fn number(self) -> u8 {
        self as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_is_handed_over_either_way_round() {
        let mut known = KnownCompliance::default();
        known.add(1, 4, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let there = known.clone().take(1, 4, [2, 3]).unwrap();
        assert_eq!(there, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let back = known.clone().take(4, 1, [3, 2]).unwrap();
        assert_eq!(back, [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
        assert_eq!(known.take(1, 1, [2, 2]), None);
        // A file of another surface tells nothing.
        assert_eq!(known.take(1, 4, [3, 3]), None);
    }
}
