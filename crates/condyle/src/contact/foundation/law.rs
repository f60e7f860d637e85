//! The foundation as a law of contact.

use std::sync::Arc;

use super::{contact::FoundationContact, settings::Foundation};
use crate::{
    contact::{
        broad_phase::{BruteForce, Coherent, Search},
        contact_law::{Bodies, ContactLaw},
        memory::ContactMemory,
        model::ContactModel,
    },
    geometry::Insert,
};

impl ContactLaw for Foundation {
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a> {
        let cache = memory.cache;
        match self.search {
            Search::Coherent => Box::new(FoundationContact::<Coherent>::after(cache, self, bodies)),
            Search::BruteForce => {
                Box::new(FoundationContact::<BruteForce>::after(cache, self, bodies))
            }
        }
    }

    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64 {
        self.pressure.pressure(0.0, insert.thickness_mm()[node]).1
    }

    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw> {
        let mut law = self.clone();
        law.slip_tolerance_mm_per_s *= factor;
        Arc::new(law)
    }
}
