//! Scalars and vectors of lanes behind one interface, and the fixed point of a map (`mixing`).
//!
//! The formulas of the hot loop are written once, for any [`Number`]. With [`F64x4`] they work on
//! four nodes at a time, which the compiler turns into vector instructions on any machine; every
//! lane does the same operations in the same order as a single number would, so the results do not
//! depend on how wide the machine's vectors are.

mod lanes;
mod mixing;
mod real;

pub(crate) use lanes::vector_from_lanes;
pub use lanes::{F32x8, F64x4, LANES, LANES_F32};
pub(crate) use mixing::{Mixing, Turns};
pub use real::{Number, cross, dot, scale_add, tangential_part, zero_vector};
