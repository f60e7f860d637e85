//! Shares under pressure, whatever presses them: what all contacts of a rigid femur have in common.
//!
//! The blocks that come near (`near_blocks`) and their samples of the femur (`cached_sample`), their loads and
//! how they rub (`traction`), what these add up to (`pressed_blocks`: `sums`, `tangent_sum`), and what every
//! node feels where an increment ends (`landing`). Between the nodes a quantity is a quadratic (`quadratic`), and the
//! highest pressure is looked for there (`peak`).

mod cached_sample;
mod landing;
mod near_blocks;
mod peak;
mod pressed_blocks;
mod quadratic;
mod sums;
mod tangent_sum;
mod traction;

pub(super) use cached_sample::CachedSample;
pub(super) use near_blocks::{NearBlock, NearBlocks};
pub(super) use peak::{MIN_NODES, highest_mpa};
pub(super) use pressed_blocks::PressedBlocks;
pub(super) use quadratic::Quadratic;
pub(super) use traction::{Coulomb, Sliding, Tractions4};
