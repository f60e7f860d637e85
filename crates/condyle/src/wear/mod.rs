//! Wear laws: what a node goes through in a cycle in, depth per cycle out.
//!
//! A law is one file: its constants with their units, defaults, limits and sources, and its
//! formula; one line here adds it.

#[cfg(test)]
mod closed_forms;
mod cross_linked;
mod law;
mod mean_cycle;
#[cfg(test)]
mod paths;

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
}

/// A metre in millimetres.
const MM_PER_M: f64 = 1000.0;
