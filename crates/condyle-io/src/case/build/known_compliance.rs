//! The compliance of a deformable insert, kept for the next run of the same one.

use condyle::contact::{Deformable, KnownCompliance};
use condyle::evolve::WearTest;
use condyle::geometry::Insert;
use condyle_fem::{Elastic, SolidError};

use super::super::contact::ContactModelWord;
use super::super::contents::Case;
use crate::cache::Keep;

/// The name under which it is kept.
const WHAT: &str = "compliance";

impl Case {
    /// Tells a law that knows nothing yet what was found of an insert's compliance before.
    ///
    /// # Errors
    /// An insert that is no elastic solid.
    pub(super) fn tell_compliance(
        &self,
        law: &Deformable,
        insert: &Insert,
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

    /// Keeps what is known of the compliance of a test's insert, if that is about more than so many pairs of tiles of its
    /// surface; about how many anything is kept then. Nothing of a foundation.
    pub fn keep_compliance(
        &self,
        test: &WearTest,
        keep: &dyn Keep,
        more_than_pairs: usize,
    ) -> usize {
        if self.contact.model != ContactModelWord::Deformable {
            return more_than_pairs;
        }
        let known = test.contact.known_compliance(&test.insert, more_than_pairs);
        let Some(known) = known else {
            return more_than_pairs;
        };
        // Room for all at once: it may be tens of megabytes.
        let room = Vec::with_capacity(known.bytes());
        if let Ok(content) = postcard::to_extend(&known, room) {
            let inputs = self.inputs_of_compliance(&test.insert);
            keep.keep(WHAT, &inputs.slices(), &content);
        }
        known.pairs()
    }

    fn inputs_of_compliance(&self, insert: &Insert) -> Inputs {
        Inputs::of(
            insert,
            self.material.elastic(),
            self.contact.backside.is_resting(),
        )
    }
}

/// All that the compliance of an unworn insert follows from, as bytes.
struct Inputs([Vec<u8>; 6]);

impl Inputs {
    fn of(insert: &Insert, elastic: Elastic, rests: bool) -> Self {
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
            // What of the backside is held.
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
