//! Wear laws: from the cycle of a node to its depth per cycle.
//!
//! A law is one file: its constants with their units, defaults, limits and sources, and its
//! formula; one line here adds it.

mod cross_linked;
mod law;
mod mean_cycle;
mod power_law_family;
#[cfg(test)]
mod tests;

pub use archard::Archard;
pub use cross_linked::CrossLinked;
pub use law::{NamedLaw, NodeWear, WearLaw, WearLawKind};
pub use mean_cycle::{MeanCycle, SharedCycle};
pub use power_law_family::FamilyConstants;
pub(crate) use power_law_family::{COLUMNS, family_columns, weighted};

law::wear_laws! {
    power_law,
    archard,
    kang,
    contact_area,
    unified,
    directional,
}

/// A metre in millimetres.
const MM_PER_M: f64 = 1000.0;
