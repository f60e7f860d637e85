//! Wear laws: one cycle's contact history in, depth per cycle out.
//!
//! A law is one file: its constants with their units, defaults, limits and sources, and its
//! formula; one line here adds it.

mod law;

pub use archard::Archard;
pub use law::{WearLaw, WearLawKind};

law::wear_laws! {
    archard,
}
