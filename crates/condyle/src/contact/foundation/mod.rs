//! The elastic foundation: rigid bodies, and pressure from local overclosure.
//!
//! [`Foundation`] is the law; it makes a [`FoundationContact`], which asks a broad phase for candidates,
//! samples the femur under them (`cached_sample`), presses those that touch (`active_block`,
//! `mean_overclosure`, `traction`), and adds up wrench, slip (`sums`) and tangent (`tangent_sum`). Where an
//! increment ends it says what every node feels (`landing`) and what the highest pressure is (`peak`).

mod active_block;
mod cached_sample;
mod contact;
mod landing;
mod law;
mod mean_overclosure;
mod peak;
mod quadratic;
mod settings;
mod sums;
mod tangent_sum;
mod traction;

pub use settings::Foundation;

#[cfg(test)]
pub(super) use cached_sample::CachedSample;
#[cfg(test)]
pub(super) use mean_overclosure::EdgeSlopes;
