//! Bodies that cases of a study have in common, and the compliance that is kept for the next run.

use std::sync::{Arc, Mutex, PoisonError};

use condyle::contact::{Deformable, KnownCompliance};
use condyle::evolve::WearTest;
use condyle::geometry;
use condyle::machine::TestedJoint;
use condyle_fem::{Elastic, SolidError};

use super::error::BuildWarning;
use super::femur::BuiltFemur;
use crate::cache::Keep;
use crate::case::contents::Case;
use crate::case::femur::Femur;
use crate::case::frame::Side;
use crate::case::insert::Insert;
use crate::case::run_options::Limits;

/// Number of bodies of each kind that are kept, the newest: enough for a few levels or designs, whatever the number
/// of cases.
const MAX_KEPT: usize = 8;
/// Number of elastic inserts that are kept, the newest ones; each takes hundreds of megabytes.
const MAX_ELASTIC: usize = 2;

/// Everything that determines an insert.
type InsertInputs = (Insert, Side, Limits);

/// Built bodies, shared by cases with equal bodies; sharing does not change any result.
///
/// Mesh files must not change while they are shared.
pub struct SharedBodies {
    pub(super) inserts: Kept<InsertInputs, geometry::Insert>,
    /// By everything that determines a femur, last the joint that the machine tests and its flexion at the start, rad.
    pub(super) femurs: Kept<(Femur, Side, Limits, (TestedJoint, f64)), BuiltFemur>,
    /// Laws of deformable inserts; their known compliance is shared among cases.
    pub(super) elastic: Kept<(InsertInputs, Elastic), Deformable>,
}

impl Default for SharedBodies {
    fn default() -> Self {
        Self {
            inserts: Kept::of(MAX_KEPT),
            femurs: Kept::of(MAX_KEPT),
            elastic: Kept::of(MAX_ELASTIC),
        }
    }
}

/// A body, with the warnings of its build.
type WithWarnings<T> = (Arc<T>, Vec<BuildWarning>);

/// The newest results by their inputs.
pub(super) struct Kept<I, T> {
    most: usize,
    made: Mutex<Vec<(I, WithWarnings<T>)>>,
}

impl<I: PartialEq, T> Kept<I, T> {
    fn of(most: usize) -> Self {
        let made = Mutex::new(Vec::new());
        Self { most, made }
    }

    /// Returns the result for the same inputs, computed if necessary; two threads may both compute it.
    pub(super) fn found_or_made<E>(
        &self,
        inputs: I,
        make: impl FnOnce(&mut Vec<BuildWarning>) -> Result<T, E>,
    ) -> Result<WithWarnings<T>, E> {
        let lock = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = lock().iter().find(|(of, _)| *of == inputs) {
            return Ok(found.clone());
        }
        // The lock is released while the result is computed, which may take minutes.
        let mut warnings = Vec::new();
        let made = (Arc::new(make(&mut warnings)?), warnings);
        let mut kept = lock();
        if kept.len() == self.most {
            kept.remove(0);
        }
        kept.push((inputs, made.clone()));
        Ok(made)
    }
}

/// Name of the kept compliance.
const WHAT: &str = "compliance";

impl Case {
    pub(super) fn insert_inputs(&self) -> InsertInputs {
        (
            self.insert.clone(),
            self.side_in_frame(),
            self.limits.clone(),
        )
    }

    /// Loads the kept compliance of an insert into a law without one.
    ///
    /// # Errors
    /// An insert that cannot be modelled as an elastic solid.
    pub(super) fn load_compliance(
        &self,
        law: &Deformable,
        insert: &geometry::Insert,
        keep: &dyn Keep,
    ) -> Result<(), SolidError> {
        if law.knows(insert) {
            return Ok(());
        }
        let inputs = self.inputs_of_compliance(insert);
        let found = keep.find(WHAT, &inputs.each_ref().map(Vec::as_slice));
        let known =
            found.and_then(|content| postcard::from_bytes::<KnownCompliance>(&content).ok());
        known.map_or(Ok(()), |known| law.know(insert, known))
    }

    /// Keeps the known compliance of a test's insert if it covers more than the given number of pairs of tiles of the
    /// surface, and returns the number of pairs that are then kept. Keeps nothing for a foundation.
    pub fn keep_compliance(
        &self,
        test: &WearTest,
        keep: &dyn Keep,
        more_than_pairs: usize,
    ) -> usize {
        if self.contact.deformable().is_none() {
            return more_than_pairs;
        }
        let known = test.contact.known_compliance(&test.insert, more_than_pairs);
        let Some(known) = known else {
            return more_than_pairs;
        };
        // Room for all is reserved at once: it may be tens of megabytes.
        let room = Vec::with_capacity(known.bytes());
        if let Ok(content) = postcard::to_extend(&known, room) {
            let inputs = self.inputs_of_compliance(&test.insert);
            keep.keep(WHAT, &inputs.each_ref().map(Vec::as_slice), &content);
        }
        known.pairs()
    }

    /// Returns everything that determines the compliance of an unworn insert, as bytes.
    fn inputs_of_compliance(&self, insert: &geometry::Insert) -> [Vec<u8>; 6] {
        let model = self.contact.deformable();
        let rests = model.is_some_and(|model| model.backside.is_resting());
        let elastic = self.material.elastic();
        let numbers = |numbers: &mut dyn Iterator<Item = f64>| -> Vec<u8> {
            numbers.flat_map(f64::to_le_bytes).collect()
        };
        let whole = |numbers: &mut dyn Iterator<Item = u32>| -> Vec<u8> {
            numbers.flat_map(u32::to_le_bytes).collect()
        };
        let surfaces = insert.surface_nodes().iter().chain(insert.backside_nodes());
        [
            numbers(&mut [elastic.youngs_modulus, elastic.poissons_ratio].into_iter()),
            numbers(&mut insert.unworn_nodes().iter().flatten().copied()),
            whole(&mut insert.mesh().hexes.iter().flatten().copied()),
            whole(&mut insert.surface_faces().iter().flatten().copied()),
            // The held part of the backside.
            vec![u8::from(rests)],
            whole(&mut surfaces.copied()),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_inputs_share_a_result_and_the_oldest_is_dropped() {
        let kept: Kept<usize, usize> = Kept::of(MAX_KEPT);
        let made = |inputs: usize| {
            let made = kept.found_or_made(inputs, |_| Ok::<_, ()>(inputs));
            made.expect("it cannot fail").0
        };
        let first = made(0);
        assert!(Arc::ptr_eq(&first, &made(0)));
        (1..=MAX_KEPT).for_each(|inputs| drop(made(inputs)));
        assert!(!Arc::ptr_eq(&first, &made(0)));
    }
}
