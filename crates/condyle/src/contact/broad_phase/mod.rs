//! Which blocks of nodes may touch: only under these does the contact sample the femur.

mod block_places;
mod brute_force;
mod coherent;
mod interface;
mod separation_bound;
mod separations;
#[cfg(test)]
mod tests;

pub(super) use brute_force::BruteForce;
pub(super) use coherent::Coherent;
pub(super) use interface::BroadPhase;
pub use interface::Search;
pub(super) use separation_bound::SeparationBound;
