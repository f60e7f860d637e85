//! One number, or several at a time.
//!
//! The formulas of the hot loop are written once, for any [`Number`]. With [`F64x4`] they work on
//! four nodes at a time, which the compiler turns into vector instructions on any machine; every
//! lane does the same operations in the same order as a single number would, so the results do not
//! depend on how wide the machine's vectors are.

mod lanes;
mod real;
pub(crate) mod vector;

pub use lanes::{F32x8, F64x4, LANES, LANES_F32};
pub use real::Number;
