//! Bodies that cases of a study have in common, and the compliance that is kept for the next run.

use std::sync::{Arc, Mutex, PoisonError};

use condyle::contact::{Deformable, KnownCompliance};
use condyle::evolve::WearTest;
use condyle::geometry;
use condyle_fem::{Elastic, SolidError};

use super::super::contents::Case;
use super::super::femur::Femur;
use super::super::frame::Side;
use super::super::insert::Insert;
use super::super::run_options::Limits;
use super::error::BuildWarning;
use super::femur::BuiltFemur;
use crate::cache::Keep;

/// Number of bodies of each kind that are kept, the newest: enough for a few levels or designs, whatever the number
/// of cases.
const MAX_KEPT: usize = 8;
/// Number of elastic inserts that are kept, the newest: each takes some hundred megabytes.
const MAX_ELASTIC: usize = 2;

/// Built bodies, shared by cases with equal bodies; sharing does not change any result.
///
/// Mesh files must not change while they are shared.
pub struct SharedBodies {
    inserts: Kept<InsertInputs, geometry::Insert>,
    femurs: Kept<FemurInputs, BuiltFemur>,
    elastic: Kept<(InsertInputs, Elastic), Deformable>,
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
pub(super) type WithWarnings<T> = (Arc<T>, Vec<BuildWarning>);

/// Everything that determines an insert.
#[derive(PartialEq)]
pub(super) struct InsertInputs(Insert, Side, Limits);

/// Everything that determines a femur; the last field is its flexion at the start, rad.
#[derive(PartialEq)]
pub(super) struct FemurInputs(Femur, Side, Limits, f64);

impl InsertInputs {
    fn of(case: &Case) -> Self {
        Self(case.insert.clone(), case.heading.side, case.limits.clone())
    }
}

impl SharedBodies {
    pub(super) fn insert<E>(
        &self,
        case: &Case,
        make: impl FnOnce(&mut Vec<BuildWarning>) -> Result<geometry::Insert, E>,
    ) -> Result<WithWarnings<geometry::Insert>, E> {
        self.inserts.found_or_made(InsertInputs::of(case), make)
    }

    /// Returns the law of a deformable insert; its known compliance is shared among cases.
    pub(super) fn elastic<E>(
        &self,
        case: &Case,
        elastic: Elastic,
        make: impl FnOnce() -> Result<Deformable, E>,
    ) -> Result<Deformable, E> {
        let inputs = (InsertInputs::of(case), elastic);
        let (law, _) = self.elastic.found_or_made(inputs, |_| make())?;
        Ok(Deformable::clone(&law))
    }

    pub(super) fn femur<E>(
        &self,
        case: &Case,
        flexion_rad: f64,
        make: impl FnOnce(&mut Vec<BuildWarning>) -> Result<BuiltFemur, E>,
    ) -> Result<WithWarnings<BuiltFemur>, E> {
        let inputs = FemurInputs(
            case.femur.clone(),
            case.heading.side,
            case.limits.clone(),
            flexion_rad,
        );
        self.femurs.found_or_made(inputs, make)
    }
}

/// The newest results by their inputs.
struct Kept<I, T> {
    most: usize,
    made: Mutex<Vec<(I, WithWarnings<T>)>>,
}

impl<I: PartialEq, T> Kept<I, T> {
    fn of(most: usize) -> Self {
        let made = Mutex::new(Vec::new());
        Self { most, made }
    }

    /// Returns the result for the same inputs, computed if necessary; two threads may both compute it.
    fn found_or_made<E>(
        &self,
        inputs: I,
        make: impl FnOnce(&mut Vec<BuildWarning>) -> Result<T, E>,
    ) -> Result<WithWarnings<T>, E> {
        if let Some(found) = self.find(&inputs) {
            return Ok(found);
        }
        let mut warnings = Vec::new();
        let made = (Arc::new(make(&mut warnings)?), warnings);
        self.keep(inputs, made.clone());
        Ok(made)
    }

    fn find(&self, inputs: &I) -> Option<WithWarnings<T>> {
        let kept = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let same = kept.iter().find(|(of, _)| of == inputs);
        same.map(|(_, found)| found.clone())
    }

    fn keep(&self, inputs: I, made: WithWarnings<T>) {
        let mut kept = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == self.most {
            kept.remove(0);
        }
        kept.push((inputs, made));
    }
}

/// Name of the kept compliance.
const WHAT: &str = "compliance";

impl Case {
    /// Loads the kept compliance of an insert into a law without one.
    ///
    /// # Errors
    /// An insert that cannot be modelled as an elastic solid.
    pub(super) fn tell_compliance(
        &self,
        law: &Deformable,
        insert: &geometry::Insert,
        keep: &dyn Keep,
    ) -> Result<(), SolidError> {
        if law.knows(insert) {
            return Ok(());
        }
        let found = keep.find(WHAT, &self.inputs_of_compliance(insert).slices());
        let found =
            found.and_then(|content| postcard::from_bytes::<KnownCompliance>(&content).ok());
        found.map_or(Ok(()), |known| law.know(insert, known))
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
            keep.keep(WHAT, &inputs.slices(), &content);
        }
        known.pairs()
    }

    fn inputs_of_compliance(&self, insert: &geometry::Insert) -> Inputs {
        let model = self.contact.deformable();
        let rests = model.is_some_and(|model| model.backside.is_resting());
        Inputs::of(insert, self.material.elastic(), rests)
    }
}

/// Everything that determines the compliance of an unworn insert, as bytes.
struct Inputs([Vec<u8>; 6]);

impl Inputs {
    fn of(insert: &geometry::Insert, elastic: Elastic, rests: bool) -> Self {
        let numbers = |numbers: &[f64]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let places = insert.unworn_nodes().iter().flatten().copied();
        let whole = |numbers: &mut dyn Iterator<Item = u32>| {
            numbers.flat_map(u32::to_le_bytes).collect::<Vec<u8>>()
        };
        Self([
            numbers(&[elastic.youngs_modulus, elastic.poissons_ratio]),
            numbers(&places.collect::<Vec<f64>>()),
            whole(&mut insert.mesh().hexes.iter().flatten().copied()),
            whole(&mut insert.surface_faces().iter().flatten().copied()),
            // The held part of the backside.
            vec![u8::from(rests)],
            whole(
                &mut [insert.surface_nodes(), insert.backside_nodes()]
                    .concat()
                    .into_iter(),
            ),
        ])
    }

    fn slices(&self) -> [&[u8]; 6] {
        self.0.each_ref().map(Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_of_the_same_is_shared_and_the_oldest_goes() {
        let kept: Kept<usize, usize> = Kept::of(MAX_KEPT);
        let made = |inputs: usize| {
            let made = kept.found_or_made(inputs, |_| Ok::<_, ()>(inputs));
            made.expect("nothing goes wrong").0
        };
        let first = made(0);
        assert!(Arc::ptr_eq(&first, &made(0)));
        (1..=MAX_KEPT).for_each(|inputs| drop(made(inputs)));
        assert!(!Arc::ptr_eq(&first, &made(0)));
    }
}
