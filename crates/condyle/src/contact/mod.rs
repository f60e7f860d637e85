//! Contact between femur and insert: one interface, several models.

mod law;

pub use law::{PressureLaw, PressureTable, PressureTableError, confined_modulus};
