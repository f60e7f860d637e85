//! The elastic foundation: rigid bodies, and pressure from local overclosure.
//!
//! [`Foundation`] is the law; it makes a `FoundationContact`, which finds the blocks that touch, presses them
//! (`press`, `mean_overclosure`), and adds up what they do, all as in [`pressed`](super::pressed). Where an
//! increment ends it says what the highest pressure is (`peak`).

mod contact;
mod law;
mod mean_overclosure;
mod peak;
mod press;
mod settings;

pub use settings::Foundation;

#[cfg(test)]
pub(super) use mean_overclosure::EdgeSlopes;
