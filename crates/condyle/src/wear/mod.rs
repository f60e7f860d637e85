//! Wear laws: from the cycle of a node to its depth per cycle.
//!
//! A law is one file: its constants with their units, defaults, limits and sources, and its
//! formula; one line here adds it.

mod cross_linked;
mod law;
mod mean_cycle;
#[cfg(test)]
mod tests;

pub use archard::Archard;
pub use cross_linked::CrossLinked;
pub use law::{NamedLaw, NodeWear, WearLaw, WearLawKind};
pub use mean_cycle::{MeanCycle, SharedCycle};

law::wear_laws! {
    archard,
    kang,
    contact_area,
    unified,
    directional,
    power_law,
}

/// A metre in millimetres.
const MM_PER_M: f64 = 1000.0;
